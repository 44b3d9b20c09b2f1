//! Advice on errors: what to do next, appended to messages that say only what is wrong.
//!
//! The libraries name no flags, since Python shows their messages too. Every flag that can help is
//! named here, or by the verb that knows what else was asked. Messages that contain their own
//! advice get none.

use crate::terminal::one_line;
use pliant_check::Error as CheckError;
use pliant_io::{Place, Reason};
use std::io::{self, ErrorKind};

/// Message of an error with its causes, `"; "` and the advice, in one line.
pub(crate) fn with_advice(error: &anyhow::Error) -> String {
    one_line(&match error.chain().find_map(advice) {
        Some(advice) => format!("{error:#}; {advice}"),
        None => format!("{error:#}"),
    })
}

fn advice(error: &(dyn std::error::Error + 'static)) -> Option<&'static str> {
    if let Some(error) = error.downcast_ref::<pliant_io::Error>() {
        reading(error)
    } else if let Some(error) = error.downcast_ref::<CheckError>() {
        checking(error)
    } else {
        writing(error.downcast_ref::<io::Error>()?.kind())
    }
}

/// Advice on errors of files that are read, and of files that `pliant convert` writes.
fn reading(error: &pliant_io::Error) -> Option<&'static str> {
    Some(match error.reason() {
        Reason::NotFound if matches!(error.place(), Place::Part(..)) => {
            "the glTF file keeps data there: copy it along, to where that file is"
        }
        Reason::NotFound => "check its path, which is taken from the current folder",
        Reason::NoMatch => {
            "the pattern is taken from the current folder; \
             `ls` with it, not quoted, shows what it matches"
        }
        Reason::Pattern(_) => "in a pattern, write [[] for the [ of a name",
        Reason::Io(_) => "see that you may read it and that its disk is there",
        Reason::Malformed(_)
        | Reason::FewCorners { .. }
        | Reason::RepeatedCorners { .. }
        | Reason::VertexIndex { .. }
        | Reason::Coordinate { .. }
        | Reason::NoVertices
        | Reason::NoFaces
        | Reason::NoFrames => "mend it, or export it again",
        Reason::Truncated(_) | Reason::Checksum { .. } => "copy it or export it again",
        Reason::TooMany { .. } => "split the mesh",
        Reason::TooLarge { .. } => "allow more memory with `--max-memory`, or split the mesh",
        Reason::SeamsTooLarge { .. } => "allow more memory with `--max-memory`, or use `--no-weld`",
        Reason::SeamsTooDense => "use a smaller `--weld`",
        Reason::BadTolerance { .. } => "choose another with `--weld`",
        Reason::ManyCorners { .. } => "triangulate the mesh first",
        Reason::OutOfMemory => "split the mesh, or free some memory",
        Reason::FacesDiffer { .. } | Reason::FaceCount { .. } | Reason::VertexCount { .. } => {
            "export all of them from one mesh"
        }
        Reason::NoBody { .. } => "choose one of these",
        Reason::NoClip { .. } => "choose one of these with `--clip`",
        Reason::BadRate { .. } => "choose another with `--fps`",
        Reason::ClipTooLong { .. } => "ask for fewer with `--fps`",
        Reason::MeshMoves { .. } => "write it to a file with `pliant convert --frames 0`",
        Reason::Exists => "choose another name, or use `--force` to write over it",
        Reason::HoldsOneFrame { .. } => {
            "name a file a frame ('name_%04d.obj'), or choose one with `--frames`"
        }
        Reason::Write(error) => return writing(error.kind()),
        _ => return None,
    })
}

fn checking(error: &CheckError) -> Option<&'static str> {
    match error {
        CheckError::Read(error) => reading(error),
        CheckError::FrameCounts { .. } => {
            Some("export the same frames of each, or one frame of what stands still")
        }
        CheckError::Missing { .. } => {
            Some("wait until it is written to its end, or export it again")
        }
        CheckError::NoSuchFrame { .. } | CheckError::NoSuchName { .. } => {
            Some("choose one of these")
        }
        CheckError::BadBaseline { .. } => Some(
            "name a file that `pliant check --format json` wrote of these bodies, \
                 without `--count` and `--first`",
        ),
        CheckError::PiecesChanged { by_name: true, .. } => {
            Some("name the whole file, without the # and what follows it")
        }
        CheckError::PiecesChanged { .. } => Some("check it as a whole, without `--split`"),
        CheckError::NoGroups { .. } => {
            Some("split it into its connected pieces with `--split components`")
        }
        CheckError::PiecesOfGroup { .. } => Some(
            "name the whole file, or write the group to a file of its own \
                 with `pliant convert` and split that",
        ),
        CheckError::NamedTwice { .. } => Some("leave out one of the two"),
        CheckError::NoClip => Some("leave out `--clip`"),
        CheckError::WithinItself => Some(
            "name two bodies or more, or make bodies of the pieces of one with `--split`; \
             leave out `--self`, or say with `--rest` what is close at rest, or with `--labels` \
             which parts are neighbours",
        ),
        CheckError::BadLabels { .. } => {
            Some("save an integer for each triangle of the first frame, or each polygon")
        }
        CheckError::LabelsWith { .. } => Some("run two checks, one of them without `--labels`"),
        CheckError::RestAlone => Some("give a distance with `--within`"),
        CheckError::BadRest { .. } => {
            Some("name a frame, or a file with the mesh of the one body that is checked")
        }
        CheckError::RestChanged { .. } | CheckError::LabelsChanged { .. } => {
            Some("check the frames before it alone, with `--frames`")
        }
        CheckError::SweptOneFrame { .. } => {
            Some("name a sequence, choose more of it with `--frames`, or leave out `--swept`")
        }
        CheckError::SweptWithin => {
            Some("run two checks, one with `--within` and one with `--swept`")
        }
        CheckError::SweptBaseline => {
            Some("run two checks, one with `--baseline` and one with `--swept`")
        }
        CheckError::EmptyGroup { .. } => Some("write NAME=BODY,BODY"),
        CheckError::Endless { .. } | CheckError::EndlessImpacts { .. } => {
            Some("mend the mesh if surfaces lie on each other, or ask for less with `--first`")
        }
        CheckError::OnePoint { .. } => Some("remove these triangles, and export the mesh again"),
        CheckError::TooManyPairs { .. } | CheckError::TooManyImpacts { .. } => Some(
            "allow more memory with `--max-memory`, or keep no list: \
             use `--count` or `--first`, without `--crossing`",
        ),
        _ => None,
    }
}

/// Advice on errors of output files. Files that are read have errors of their own.
fn writing(kind: ErrorKind) -> Option<&'static str> {
    match kind {
        ErrorKind::NotFound => Some("make its folder first"),
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            Some("choose a place where you may write")
        }
        ErrorKind::IsADirectory => Some("name a file in it"),
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => Some("choose another name"),
        ErrorKind::StorageFull => Some("free some space"),
        _ => None,
    }
}
