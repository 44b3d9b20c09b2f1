//! Labels of the triangles of sources, from files.
//!
//! The world keeps labels until a body gets another mesh, as when its seams open. So they are given
//! again from here, which only works for the mesh that they are of.

use crate::error::Error;
use crate::filter::Names;
use crate::settings::LabelFile;
use pliant::Labels;

/// Labels of the triangles of a source's first mesh.
pub(crate) type SourceLabels = Vec<u32>;

/// Reads the labels of each source; `None` for a source without. `most` is the limit of the memory
/// of each file, in bytes.
///
/// A file has a label for each triangle, or for each polygon. A negative one is no label.
pub(crate) fn read(
    asked: &[LabelFile],
    names: &Names,
    most: u64,
) -> Result<Vec<Option<SourceLabels>>, Error> {
    let (sources, bodies) = (names.sources, names.bodies);
    let mut all: Vec<Option<SourceLabels>> = sources.iter().map(|_| None).collect();
    for LabelFile { body, file } in asked {
        let bad = |why: String| Error::BadLabels {
            file: file.clone(),
            why,
        };
        let called = names.of_bodies(body);
        let called = called.ok_or_else(|| names.unknown("body", body))?;
        let number = bodies.facts(sources, called[0]).source;
        if bodies.of_source(number).ne(called.iter().copied()) {
            let is_several = "stands for several bodies, or for a part of one";
            return Err(bad(format!(
                "{is_several}: {body}; labels are of a whole body"
            )));
        }
        if all[number].is_some() {
            return Err(bad(format!("{body} has labels already")));
        }
        let source = &sources[number];
        let labels = pliant_io::integers(file, source.among(), most)?;
        let (triangles, polygons) = (source.triangles().len(), source.faces());
        let of_polygons = polygons.map_or(0, |of| of.iter().max().map_or(0, |last| last + 1));
        let label = |place: usize| match u32::try_from(labels[place]) {
            Ok(label) if label != Labels::NONE => Ok(label),
            _ if labels[place] < 0 => Ok(Labels::NONE),
            _ => Err(bad(format!(
                "label {} of number {place} is too large; the largest is {}",
                labels[place],
                Labels::NONE - 1
            ))),
        };
        let of_source: Result<SourceLabels, Error> = match polygons {
            _ if labels.len() == triangles => (0..triangles).map(label).collect(),
            Some(polygons) if labels.len() == of_polygons as usize => {
                polygons.iter().map(|&it| label(it as usize)).collect()
            }
            _ => {
                let count = labels.len();
                let or_polygons = match polygons {
                    Some(_) => format!(" of {of_polygons} polygons"),
                    None => String::new(),
                };
                let name = source.name();
                return Err(bad(format!(
                    "it has {count} labels, and {name} {triangles} triangles{or_polygons}"
                )));
            }
        };
        all[number] = Some(of_source?);
    }
    Ok(all)
}
