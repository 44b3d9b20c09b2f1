//! Names and descriptions of all experiments, also in a build without the feature `peers`.
//!
//! Such a build lists experiments with other libraries, though it cannot run them.

/// Name and description of an experiment.
#[derive(Clone, Copy, Debug)]
pub struct Title {
    /// Name on the command line.
    pub name: &'static str,
    /// Description in one line.
    pub about: &'static str,
    /// Whether other libraries take part: only a build with the feature `peers` has it.
    pub with_peers: bool,
}

/// All experiments in the order of `all`, whether or not this build has them.
pub const TITLES: [Title; 15] = [
    EXPERIMENT_1,
    TABLE_1,
    EXPERIMENT_3,
    DEGREES,
    SPLITS,
    LEVELS,
    BODIES,
    CLOTH,
    DEGENERATE,
    SHAPES,
    PEERS,
    NEAR,
    CLOSE,
    WHEN,
    CHANGE,
];

pub(super) const EXPERIMENT_1: Title = Title {
    name: "experiment-1",
    about: "figure 3: two spheres of 20,480 triangles, all and first pairs",
    with_peers: true,
};

pub(super) const TABLE_1: Title = Title {
    name: "table-1",
    about: "table 1: two spheres, of 1,280 to 1,310,720 triangles",
    with_peers: false,
};

pub(super) const EXPERIMENT_3: Title = Title {
    name: "experiment-3",
    about: "figure 4: 27 bodies of 5,120 triangles that hit each other",
    with_peers: true,
};

pub(super) const DEGREES: Title = Title {
    name: "degrees",
    about: "trees of degree 2, 4 and 8, ours and van den Bergen's",
    with_peers: false,
};

pub(super) const SPLITS: Title = Title {
    name: "splits",
    about: "trees cut at the centre, at the mean, along the mesh, equally",
    with_peers: false,
};

pub(super) const LEVELS: Title = Title {
    name: "levels",
    about: "the hybrid's level from 0 (top-down) to n (bottom-up)",
    with_peers: false,
};

pub(super) const BODIES: Title = Title {
    name: "bodies",
    about: "brute force, sweep and prune, a tree; 10 to 10,000 bodies",
    with_peers: false,
};

pub(super) const CLOTH: Title = Title {
    name: "cloth",
    about: "a folding sheet of 79,202 triangles with itself",
    with_peers: true,
};

pub(super) const DEGENERATE: Title = Title {
    name: "degenerate",
    about: "coplanar grids that slide; spheres 10^4 from the origin",
    with_peers: true,
};

pub(super) const SHAPES: Title = Title {
    name: "shapes",
    about: "long thin triangles, planes in common, very many at a vertex",
    with_peers: false,
};

pub(super) const PEERS: Title = Title {
    name: "peers",
    about: "spheres, a crowd and a cloth, with parry3d, obvhs and the floor",
    with_peers: true,
};

pub(super) const NEAR: Title = Title {
    name: "near",
    about: "what is near, with parry3d and obvhs with grown boxes",
    with_peers: true,
};

pub(super) const CLOSE: Title = Title {
    name: "close",
    about: "close pairs over candidates, and distances, with parry3d",
    with_peers: true,
};

pub(super) const WHEN: Title = Title {
    name: "when",
    about: "what meets on its way, over candidates and intersections",
    with_peers: false,
};

pub(super) const CHANGE: Title = Title {
    name: "change",
    about: "meshes that change: cut, torn, fused, remeshed; trees that decay",
    with_peers: true,
};
