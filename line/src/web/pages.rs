//! The view of a board and the pages that are open: each gets the whole state, then its changes.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use serde_json::{Value, json};
use tenax_frames::play;

use super::source::News;
use crate::view::View;

/// Changes that a page may be behind: 20 s. A page that is further behind is dropped, and connects again.
const CHANGES: usize = 4_096;

#[derive(Default)]
pub struct Pages {
    pub view: View,
    pages: Vec<SyncSender<Value>>,
}

impl Pages {
    pub fn join(&mut self) -> Receiver<Value> {
        let (page, changes) = sync_channel(CHANGES);
        // There is room.
        let _sent = page.try_send(self.view.whole());
        self.pages.push(page);
        changes
    }

    /// Changes the view, and sends its changes to the pages.
    pub fn with<T>(&mut self, change: impl FnOnce(&mut View) -> T) -> T {
        let done = change(&mut self.view);
        for change in self.view.take_changes() {
            self.pages.retain(|page| page.try_send(change.clone()).is_ok());
        }
        done
    }

    pub fn take(&mut self, news: News) {
        self.with(|view| match news {
            News::Open => view.open(),
            News::Gone(why) => view.gone(&why),
            News::Moved(words) => view.say(&words),
            News::Frame(frame, counts) => view.frame(frame.as_ref().map_err(|bad| *bad), counts),
            News::Played(play::Told::Message(heard)) => view.hear(&heard),
            News::Played(play::Told::At(playing)) => view.tell(json!({ "playing": playing })),
            News::Played(play::Told::Again) => view.begin_anew(),
            News::Answered(command, Ok(answer)) => view.answered(&command, &answer),
            News::Answered(command, Err(why)) => view.say(&format!("> {command:?}: {why}")),
        });
    }
}
