//! What all frames of a check come to, and the lines that say it.

use crate::check::figures::{counted, short};
use crate::table::grouped;
use pliant_check::{Found, Interval, Kinds};

/// What all frames so far come to.
#[derive(Default)]
pub(super) struct Tally {
    pub(super) frames: usize,
    pub(super) intersecting: usize,
    /// The distance that was asked for, if not what intersects was.
    pub(super) within: Option<f64>,
    /// The frame with the nearest pair, and how far apart it is.
    pub(super) nearest: Option<(usize, f64)>,
    /// The frame with the most pairs, and their number; none where not all pairs are known.
    pub(super) worst: Option<(usize, usize)>,
    /// How many pairs are of which kind, in frames of which all were asked for.
    pub(super) kinds: Kinds,
    /// Pairs that are left out, for their places only touch.
    pub(super) only_touching: usize,
    /// Pairs with a triangle that has no area, counted or left out.
    pub(super) degenerate: usize,
    /// Intervals between frames that were looked at, and those in which something meets.
    pub(super) intervals: [usize; 2],
    /// The frames of the first that was not, for a mesh changes in it, and how many were not.
    pub(super) skipped: Option<([usize; 2], usize)>,
}

impl Tally {
    pub(super) fn count(&mut self, found: &Found) {
        self.frames += 1;
        self.intersecting += usize::from(found.count > 0);
        self.degenerate += found.degenerate;
        self.only_touching += found.only_touching.unwrap_or(0);
        let kinds = found.kinds.unwrap_or_default();
        self.kinds.crossing += kinds.crossing;
        self.kinds.overlapping += kinds.overlapping;
        self.kinds.touching += kinds.touching;
        if let Some(distance) = found.distance
            && self.nearest.is_none_or(|(_, least)| distance < least)
        {
            self.nearest = Some((found.frame, distance));
        }
        if found.complete && found.count > self.worst.map_or(0, |(_, most)| most) {
            self.worst = Some((found.frame, found.count));
        }
    }

    pub(super) fn count_interval(&mut self, interval: &Interval) {
        if interval.changed.is_empty() {
            self.intervals[0] += 1;
            self.intervals[1] += usize::from(interval.count > 0);
        } else {
            let (_, count) = self
                .skipped
                .get_or_insert(([interval.frame, interval.until], 0));
            *count += 1;
        }
    }

    /// One line for people about pairs that do not cross: those counted, or those of places that were left out.
    pub(super) fn kinds(&self, leaves_touching_out: bool) -> Option<String> {
        if leaves_touching_out {
            let pairs = counted((self.only_touching, "pair of a place", "pairs of places"));
            return Some(format!("left out: {pairs} where surfaces only touch"));
        }
        let Kinds {
            crossing,
            overlapping,
            touching,
        } = self.kinds;
        if overlapping + touching == 0 {
            return None;
        }
        let [cross, overlap, touch] = [crossing, overlapping, touching].map(|n| grouped(n as u64));
        Some(format!(
            "{cross} of these pairs cross, {overlap} overlap in a plane, {touch} touch; `--crossing` leaves out places where surfaces only touch"
        ))
    }

    /// One line for people about what meets between frames, if that was asked.
    pub(super) fn swept(&self) -> Option<String> {
        let [looked_at, meeting] = self.intervals.map(|n| grouped(n as u64));
        let not = match self.skipped {
            None if self.intervals[0] == 0 => return None,
            None => String::new(),
            Some((_, count)) => {
                format!(
                    "; {} not looked at, for a mesh changes",
                    grouped(count as u64)
                )
            }
        };
        Some(format!(
            "on the way from a frame to the next something meets in {meeting} of {looked_at}{not}"
        ))
    }

    /// One line for people.
    pub(super) fn summary(&self) -> String {
        let [intersecting, frames] = [self.intersecting, self.frames].map(|n| grouped(n as u64));
        let worst = self.worst.map_or_else(String::new, |(frame, count)| {
            format!("; most pairs: {} in frame {frame}", grouped(count as u64))
        });
        let Some(within) = self.within else {
            return format!("{intersecting} of {frames} frames intersect{worst}");
        };
        let nearest = self.nearest.map_or_else(String::new, |(frame, distance)| {
            format!("; least distance: {} in frame {frame}", short(distance))
        });
        format!(
            "{intersecting} of {frames} frames have triangles of two bodies at most {within} apart{nearest}{worst}"
        )
    }
}
