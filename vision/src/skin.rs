//! The skin's move under an object from one picture to the next. The markers nearest to the object's middle count most.

use crate::frame::Point;
use crate::markers::Marker;
use crate::motion::{ARM_PX, Flow};

const REACH_PX: f32 = 75.0;
/// Below this sum of weights no marker is near.
const WEIGHT_MIN: f32 = 0.5;

/// Places of the sure markers in the picture before.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    before: Vec<Option<Point>>,
}

impl Skin {
    pub fn remember(&mut self, markers: &[Marker]) {
        self.before = markers.iter().map(|marker| is_sure(marker).then_some(marker.at)).collect();
    }

    /// Move of the skin at `middle`. None where no marker near it was found in both pictures.
    pub fn flow(&self, markers: &[Marker], middle: Point) -> Option<Flow> {
        let (mut w, mut x, mut y, mut turn, mut arm) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let mut moves = Vec::new();
        for (marker, before) in markers.iter().zip(&self.before) {
            let Some(before) = before.filter(|_| is_sure(marker)) else { continue };
            let far = marker.at.distance(middle) / REACH_PX;
            let weight = libm::expf(-2.3 * far * far);
            let moved = Point { x: marker.at.x - before.x, y: marker.at.y - before.y };
            moves.push((weight, Point { x: before.x - middle.x, y: before.y - middle.y }, moved));
            (w, x, y) = (w + weight, x + weight * moved.x, y + weight * moved.y);
        }
        if w < WEIGHT_MIN {
            return None;
        }
        (x, y) = (x / w, y / w);
        for (weight, at, moved) in &moves {
            turn += weight * (at.x * (moved.y - y) - at.y * (moved.x - x));
            arm += weight * (at.x * at.x + at.y * at.y);
        }
        // One marker alone in the middle says nothing of a turn.
        Some(Flow { x, y, turn: if arm > ARM_PX { turn / arm * ARM_PX } else { 0.0 } })
    }
}

fn is_sure(marker: &Marker) -> bool {
    marker.found.is_ok() && marker.known()
}
