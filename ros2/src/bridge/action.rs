//! The actions `GripperCommand` (`/NAME/gripper_cmd`) and `ParallelGripperCommand` (`/NAME/parallel_gripper_cmd`): services and topics as
//! ROS 2's action protocol names them.

use std::sync::mpsc::{Receiver, channel};

use crate::hand::header;
use crate::key::Role;
use crate::message::{
    CancelResponse, Feedback, GoalId, GoalInfo, GoalStatusArray, Gripper, GripperCommand, JointState,
    Message, ParallelGripper, ResultResponse, SendGoal, SendGoalResponse, Time,
};
use zenoh::query::Queryable;

use super::network::{Graph, Publisher, Request, now_ns};

const EXECUTING: i8 = 2;
pub const SUCCEEDED: i8 = 4;
const CANCELLED: i8 = 5;
pub const ABORTED: i8 = 6;
/// Goals that have ended and whose results are kept.
const KEPT: usize = 16;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Goal,
    Result,
    Cancel,
}

struct Goal {
    info: GoalInfo,
    status: i8,
    result: Gripper,
    waiting: Vec<Request>,
}

/// One of the two actions.
pub struct Action<'a> {
    name: String,
    parallel: bool,
    requests: Receiver<(Asked, Request)>,
    feedback: Publisher<'a>,
    status: Publisher<'a>,
    goals: Vec<Goal>,
    _services: Vec<Queryable<()>>,
}

impl<'a> Action<'a> {
    pub fn new(graph: &mut Graph<'a>, name: &str, parallel: bool) -> anyhow::Result<Self> {
        let (at, kind) = match parallel {
            true => (
                format!("/{name}/parallel_gripper_cmd/_action"),
                "control_msgs/action/ParallelGripperCommand",
            ),
            false => (format!("/{name}/gripper_cmd/_action"), "control_msgs/action/GripperCommand"),
        };
        let (told, requests) = channel();
        let mut services = Vec::new();
        for (asked, end, of) in [
            (Asked::Goal, "send_goal", format!("{kind}_SendGoal")),
            (Asked::Result, "get_result", format!("{kind}_GetResult")),
            (Asked::Cancel, "cancel_goal", "action_msgs/srv/CancelGoal".to_owned()),
        ] {
            let told = told.clone();
            let ask = move |request| _ = told.send((asked, request));
            services.push(graph.service(&format!("{at}/{end}"), &of, ask)?);
        }
        Ok(Self {
            name: name.to_owned(),
            parallel,
            requests,
            feedback: graph.publishes(
                Role::Publisher,
                &format!("{at}/feedback"),
                &format!("{kind}_FeedbackMessage"),
            )?,
            status: graph.publishes(Role::Latched, &format!("{at}/status"), GoalStatusArray::NAME)?,
            goals: Vec::new(),
            _services: services,
        })
    }

    /// Answers what was asked. `begin` takes a goal's command, or refuses it. True: the goal that went on is cancelled.
    pub fn serve(&mut self, mut begin: impl FnMut(&GripperCommand) -> bool) -> anyhow::Result<bool> {
        let mut cancelled = false;
        while let Ok((asked, request)) = self.requests.try_recv() {
            match asked {
                Asked::Goal => self.take(&request, &mut begin)?,
                Asked::Result => self.give(request),
                Asked::Cancel => cancelled |= self.cancel(&request)?,
            }
        }
        Ok(cancelled)
    }

    fn take(
        &mut self,
        request: &Request,
        begin: &mut impl FnMut(&GripperCommand) -> bool,
    ) -> anyhow::Result<()> {
        let asked = match self.parallel {
            true => request.message::<SendGoal<JointState>>().map(|asked| {
                let [position, max_effort] =
                    [&asked.goal.position, &asked.goal.effort].map(|all| all.first().copied());
                // Without a position it is no command; without an effort the object is only felt.
                let position = position.unwrap_or(f64::NAN);
                (asked.goal_id, GripperCommand { position, max_effort: max_effort.unwrap_or_default() })
            }),
            false => request.message::<SendGoal<GripperCommand>>().map(|asked| (asked.goal_id, asked.goal)),
        };
        let Some((goal_id, command)) = asked else { return Ok(()) };
        let info = GoalInfo { goal_id, stamp: Time::of_ns(now_ns()) };
        let accepted = self.find(&goal_id).is_none() && begin(&command);
        if accepted {
            self.end(ABORTED, Gripper::default())?;
            self.goals.push(Goal {
                info,
                status: EXECUTING,
                result: Gripper::default(),
                waiting: Vec::new(),
            });
            let ended = self.goals.len().saturating_sub(KEPT);
            self.goals.drain(..ended);
            self.tell()?;
        }
        request.answer(&SendGoalResponse { accepted, stamp: info.stamp });
        Ok(())
    }

    fn give(&mut self, request: Request) {
        let Some(goal_id) = request.message::<GoalId>() else { return };
        let parallel = self.parallel;
        match self.goals.iter_mut().find(|goal| goal.info.goal_id == goal_id) {
            Some(goal) if goal.status == EXECUTING => goal.waiting.push(request),
            Some(goal) => answer(&self.name, parallel, &request, goal.status, goal.result),
            None => answer(&self.name, parallel, &request, 0, Gripper::default()),
        }
    }

    fn cancel(&mut self, request: &Request) -> anyhow::Result<bool> {
        let Some(asked) = request.message::<GoalInfo>() else { return Ok(false) };
        // An id of zeros means all of them, of which one goes on at most.
        let all = asked.goal_id == GoalId::default();
        let goes_on = |goal: &&Goal| goal.status == EXECUTING && (all || goal.info.goal_id == asked.goal_id);
        let goals_canceling: Vec<GoalInfo> =
            self.goals.iter().filter(goes_on).map(|goal| goal.info).collect();
        let cancelled = !goals_canceling.is_empty();
        let return_code = match self.find(&asked.goal_id) {
            Some(_) if !cancelled => 3,
            None if !cancelled && !all => 2,
            _ => 0,
        };
        if cancelled {
            self.end(CANCELLED, Gripper::default())?;
        }
        request.answer(&CancelResponse { return_code, goals_canceling });
        Ok(cancelled)
    }

    fn find(&self, goal_id: &GoalId) -> Option<&Goal> {
        self.goals.iter().find(|goal| goal.info.goal_id == *goal_id)
    }

    /// The goal that goes on, if there is one, has ended so.
    pub fn end(&mut self, status: i8, result: Gripper) -> anyhow::Result<()> {
        let Some(goal) = self.goals.iter_mut().find(|goal| goal.status == EXECUTING) else { return Ok(()) };
        (goal.status, goal.result) = (status, result);
        for request in goal.waiting.drain(..) {
            answer(&self.name, self.parallel, &request, status, result);
        }
        self.tell()
    }

    fn tell(&mut self) -> anyhow::Result<()> {
        let status_list = self.goals.iter().map(|goal| (goal.info, goal.status)).collect();
        self.status.publish(&GoalStatusArray { status_list })
    }

    /// Feedback of the goal that goes on.
    pub fn feed(&mut self, now: Gripper) -> anyhow::Result<()> {
        let Some(goal) = self.goals.iter().find(|goal| goal.status == EXECUTING) else { return Ok(()) };
        let goal_id = goal.info.goal_id;
        match self.parallel {
            true => self.feedback.publish(&Feedback { goal_id, feedback: state(&self.name, now) }),
            false => self.feedback.publish(&Feedback { goal_id, feedback: now }),
        }
    }
}

fn state(name: &str, now: Gripper) -> JointState {
    let header = header(name, now_ns());
    let [position, effort] = [now.position, now.effort].map(|value| vec![value]);
    JointState { header, name: vec![format!("{name}_grip")], position, effort, ..JointState::default() }
}

fn answer(name: &str, parallel: bool, request: &Request, status: i8, result: Gripper) {
    let Gripper { stalled, reached_goal, .. } = result;
    if parallel {
        let result = ParallelGripper { state: state(name, result), stalled, reached_goal };
        request.answer(&ResultResponse { status, result });
    } else {
        request.answer(&ResultResponse { status, result });
    }
}
