"""Checks a folder of sequences with Dask, frame range by frame range.

    python folder_with_dask.py FOLDER [--workers N] [--frames-per-task N]

Every `.npz` file in the folder (vertices (T, n, 3), faces (m, 3)) is a sequence that is checked against itself. Tasks are ranges
of frames of a file; answers do not depend on how they are cut. A worker reads the frames before its range too, but does not check
them: reading is the cheaper part.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import NamedTuple

import pliant
from dask.distributed import Client, LocalCluster


class Task(NamedTuple):
    """Some frames of one file."""

    file: str
    frames: range


def tasks(folder: Path, frames_per_task: int) -> list[Task]:
    """The files of a folder, cut into ranges of frames."""
    cut = []
    for file in sorted(folder.glob("*.npz")):
        count = pliant.check(file).frame_count
        for start in range(0, count, frames_per_task):
            cut.append(Task(str(file), range(start, min(start + frames_per_task, count))))
    return cut


def check(task: Task) -> list[pliant.Frame]:
    """The frames of a task, with all their pairs."""
    return list(pliant.check(task.file, frames=task.frames))


def check_folder(client: Client, folder: Path, frames_per_task: int) -> dict[str, list[pliant.Frame]]:
    """All frames of all files, in order."""
    cut = tasks(folder, frames_per_task)
    checked: dict[str, list[pliant.Frame]] = {task.file: [] for task in cut}
    # Results come in the order of the tasks, whichever worker was first.
    for task, frames in zip(cut, client.gather(client.map(check, cut))):
        checked[task.file] += frames
    return checked


def main() -> None:
    parser = argparse.ArgumentParser(description="Checks every .npz sequence of a folder against itself.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--workers", type=int, default=None, help="processes; as many as there are cores")
    parser.add_argument("--frames-per-task", type=int, default=20)
    arguments = parser.parse_args()
    if not any(arguments.folder.glob("*.npz")):
        sys.exit(f"{arguments.folder}: there is no .npz file in it")
    cluster = LocalCluster(n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None)
    with cluster, Client(cluster) as client:
        for file, frames in check_folder(client, arguments.folder, arguments.frames_per_task).items():
            worst = max(frames, key=lambda frame: frame.count)
            hit = sum(frame.count > 0 for frame in frames)
            print(f"{file}: {hit} of {len(frames)} frames intersect; most pairs: {worst.count:,} in frame {worst.frame}")


if __name__ == "__main__":
    main()
