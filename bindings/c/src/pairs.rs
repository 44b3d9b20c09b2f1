//! Functions on single pairs of elements and of triangles, without a world.

use crate::points::{Corners, F32, PliantPoints, Written, some_at_a_time};
use crate::status::{DIFFERENT_COUNTS, PliantError, PliantStatus, Refused, call};
use pliant::{ClosestFeatures, ContactKind, Error, ErrorKind, PairDistance, Scalar};

/// Error about pairs of which some came before: the number is that among all.
fn behind(first: usize, mut error: Error) -> Refused {
    if let ErrorKind::BadCorner { pair, .. } = &mut error.kind {
        *pair += first;
    }
    error.into()
}

/// Values of `pliant_features`.
pub(crate) fn number_of(features: ClosestFeatures) -> u8 {
    match features {
        ClosestFeatures::VertexVertex => 0,
        ClosestFeatures::VertexEdge => 1,
        ClosestFeatures::VertexFace => 2,
        ClosestFeatures::EdgeEdge => 3,
    }
}

/// Values of `pliant_contact`.
pub(crate) fn number_of_contact(kind: Option<ContactKind>) -> u8 {
    match kind {
        None => 0,
        Some(ContactKind::Touching) => 1,
        Some(ContactKind::Overlapping) => 2,
        Some(ContactKind::Crossing) => 3,
    }
}

/// Times of impact of pairs, and where they go.
struct Impacts {
    are_edges: bool,
    width: f64,
    hit: Written<u8, 1>,
    low: Written<f64, 1>,
    high: Written<f64, 1>,
}

impl Impacts {
    fn of(&self, start: &Corners<4>, end: &Corners<4>) -> Result<(), Refused> {
        if start.count() != end.count() || start.scalar() != end.scalar() {
            return Err(Refused::new(
                DIFFERENT_COUNTS,
                format_args!(
                    "start has {} pairs and end {}; give as many, of one scalar",
                    start.count(),
                    end.count()
                ),
            ));
        }
        if start.scalar() == F32 {
            self.find::<f32>(start, end)
        } else {
            self.find::<f64>(start, end)
        }
    }

    fn find<S: Scalar>(&self, start: &Corners<4>, end: &Corners<4>) -> Result<(), Refused> {
        let find = if self.are_edges {
            pliant::edge_edge_impacts::<S>
        } else {
            pliant::vertex_triangle_impacts::<S>
        };
        // Without pairs a width that is bad is refused, too.
        find(&[], &[], self.width)?;
        some_at_a_time([start, end], |first, [start, end]| {
            let found = find(start, end, self.width).map_err(|error| behind(first, error))?;
            for (pair, times) in (first..).zip(found) {
                let [low, high] = times.unwrap_or([f64::NAN; 2]);
                self.hit.set(pair, [u8::from(times.is_some())]);
                self.low.set(pair, [low]);
                self.high.set(pair, [high]);
            }
            Ok(())
        })
    }
}

/// Distances of pairs, and where they go.
struct Distances {
    are_edges: bool,
    distance: Written<f64, 1>,
    direction: Written<f64, 3>,
    weights: Written<f64, 4>,
    features: Written<u8, 1>,
}

impl Distances {
    fn of(&self, corners: &Corners<4>) -> Result<(), Refused> {
        if corners.scalar() == F32 {
            self.find::<f32>(corners)
        } else {
            self.find::<f64>(corners)
        }
    }

    fn find<S: Scalar>(&self, corners: &Corners<4>) -> Result<(), Refused> {
        some_at_a_time([corners], |first, [pairs]| {
            let mut pair = first;
            let write = |found: PairDistance| {
                self.distance.set(pair, [found.distance]);
                self.direction
                    .set(pair, found.direction.unwrap_or_default());
                self.weights.set(pair, found.weights);
                self.features.set(pair, [number_of(found.features)]);
                pair += 1;
            };
            let done = pliant::pair_distances::<S>(self.are_edges, pairs, write);
            done.map_err(|error| behind(first, error))
        })
    }
}

/// Contacts of pairs of triangles, into an array.
fn contacts<S: Scalar>(corners: &Corners<6>, contact: &Written<u8, 1>) -> Result<(), Refused> {
    some_at_a_time::<S, 6, 1>([corners], |first, [pairs]| {
        let found = pliant::triangle_contacts(pairs).map_err(|error| behind(first, error))?;
        for (pair, kind) in (first..).zip(found) {
            contact.set(pair, [number_of_contact(kind)]);
        }
        Ok(())
    })
}

/// `pliant_vertex_triangle_impacts`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_vertex_triangle_impacts(
    start: *const PliantPoints,
    end: *const PliantPoints,
    width: f64,
    hit: *mut u8,
    low: *mut f64,
    high: *mut f64,
    error: *mut PliantError,
) -> PliantStatus {
    // SAFETY: as the header says.
    unsafe {
        let impacts = Impacts {
            are_edges: false,
            width,
            hit: Written::new(hit),
            low: Written::new(low),
            high: Written::new(high),
        };
        call(error, || {
            let (start, end) = (Corners::new(start, "start")?, Corners::new(end, "end")?);
            impacts.of(&start, &end)
        })
    }
}

/// `pliant_edge_edge_impacts`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_edge_edge_impacts(
    start: *const PliantPoints,
    end: *const PliantPoints,
    width: f64,
    hit: *mut u8,
    low: *mut f64,
    high: *mut f64,
    error: *mut PliantError,
) -> PliantStatus {
    // SAFETY: as the header says.
    unsafe {
        let impacts = Impacts {
            are_edges: true,
            width,
            hit: Written::new(hit),
            low: Written::new(low),
            high: Written::new(high),
        };
        call(error, || {
            let (start, end) = (Corners::new(start, "start")?, Corners::new(end, "end")?);
            impacts.of(&start, &end)
        })
    }
}

/// `pliant_vertex_triangle_distances`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_vertex_triangle_distances(
    corners: *const PliantPoints,
    distance: *mut f64,
    direction: *mut f64,
    weights: *mut f64,
    features: *mut u8,
    error: *mut PliantError,
) -> PliantStatus {
    // SAFETY: as the header says.
    unsafe {
        let distances = Distances {
            are_edges: false,
            distance: Written::new(distance),
            direction: Written::new(direction),
            weights: Written::new(weights),
            features: Written::new(features),
        };
        call(error, || distances.of(&Corners::new(corners, "corners")?))
    }
}

/// `pliant_edge_edge_distances`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_edge_edge_distances(
    corners: *const PliantPoints,
    distance: *mut f64,
    direction: *mut f64,
    weights: *mut f64,
    features: *mut u8,
    error: *mut PliantError,
) -> PliantStatus {
    // SAFETY: as the header says.
    unsafe {
        let distances = Distances {
            are_edges: true,
            distance: Written::new(distance),
            direction: Written::new(direction),
            weights: Written::new(weights),
            features: Written::new(features),
        };
        call(error, || distances.of(&Corners::new(corners, "corners")?))
    }
}

/// `pliant_triangle_contacts`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_triangle_contacts(
    corners: *const PliantPoints,
    contact: *mut u8,
    error: *mut PliantError,
) -> PliantStatus {
    // SAFETY: as the header says.
    unsafe {
        let contact = Written::new(contact);
        call(error, || {
            let corners = Corners::new(corners, "corners")?;
            if corners.scalar() == F32 {
                contacts::<f32>(&corners, &contact)
            } else {
                contacts::<f64>(&corners, &contact)
            }
        })
    }
}
