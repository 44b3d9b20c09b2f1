//! Every invariant of a body, looked at one by one.

use super::Body;
use crate::geometry::Origin;
use crate::kernels::Coordinate;
use crate::options::Options;
use crate::tree::Swept;

impl<S: Coordinate> Body<S> {
    /// Checks the structure of the tree, and that each box that claims to be valid is the box over the vertices below it as they
    /// are now. A sentence says what is wrong.
    pub(crate) fn validate(&self, options: &Options, origin: Origin) -> Result<(), String> {
        let (shape, order) = (&self.shape, self.mesh.order());
        let now = shape.sorted(order);
        let from = shape.view_of(&now, order, origin);
        let end = self
            .motion
            .on()
            .map(|way| (way.end(), way.end().sorted(order)));
        let to = end.as_ref();
        let to = to.map(|(end, sorted)| end.view_of(sorted, order, origin));
        let mut next = 0;
        for part in self.parts.all() {
            let triangles = part.triangles();
            if triangles.start != next {
                return Err(format!("a part begins at {}, not {next}", triangles.start));
            }
            next = triangles.end;
            part.validate(order, options.partition, Swept { from, to })?;
        }
        if next as usize != self.triangle_count() {
            return Err("the parts do not hold all triangles".into());
        }
        self.mesh.validate()
    }
}
