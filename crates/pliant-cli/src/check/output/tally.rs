//! Totals over all frames of a check, and the lines that say them.

use super::inside::InsideTally;
use crate::check::adjacent::AdjacentTally;
use crate::check::figures::counted;
use crate::table::{grouped, short};
use pliant_check::{Found, Interval, Kinds};

/// Totals over all frames so far.
#[derive(Default)]
pub(super) struct Tally {
    pub(super) frames: usize,
    pub(super) intersecting: usize,
    /// Largest distance of pairs. `None`: pairs intersect.
    pub(super) within: Option<f64>,
    /// Frame with the nearest pair, and the distance of that pair.
    pub(super) nearest: Option<(usize, f64)>,
    /// Frame with the most pairs, and their number. Frames with unknown pairs do not count.
    pub(super) worst: Option<(usize, usize)>,
    /// Number of pairs of each kind, in frames all of whose pairs were asked for.
    pub(super) kinds: Kinds,
    /// Number of pairs left out because their places only touch.
    pub(super) only_touching: usize,
    /// Pairs that share a vertex.
    pub(super) adjacent: AdjacentTally,
    /// Components inside bodies.
    pub(super) inside: InsideTally,
    /// Number of pairs with a triangle without area, counted or left out.
    pub(super) degenerate: usize,
    /// Number of intervals between frames that were searched, and of those with a contact.
    pub(super) intervals: [usize; 2],
    /// First interval skipped because a mesh changes in it, and the number of all such intervals.
    pub(super) skipped: Option<([usize; 2], usize)>,
}

impl Tally {
    pub(super) fn count(&mut self, found: &Found) {
        self.frames += 1;
        self.intersecting += usize::from(found.count_of_all() > 0);
        if let Some(adjacent) = &found.adjacent {
            self.degenerate += adjacent.degenerate;
            self.only_touching += adjacent.only_touching.unwrap_or(0);
        }
        self.adjacent.count(found);
        self.inside.count(found);
        self.degenerate += found.degenerate;
        self.only_touching += found.only_touching.unwrap_or(0);
        self.kinds += found.kinds.unwrap_or_default();
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

    /// A line about pairs that do not cross, or about places left out because they only touch.
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
            "{cross} of these pairs cross, {overlap} overlap in a plane, {touch} touch; \
             `--crossing` leaves out places where surfaces only touch"
        ))
    }

    /// A line about contacts between frames, if they were asked for.
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

    /// A line about all frames.
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
            "{intersecting} of {frames} frames have triangles at most {within} apart\
             {nearest}{worst}"
        )
    }
}
