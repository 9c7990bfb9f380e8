"""The folder that a driver empties before it begins."""

import pathlib
import shutil
import sys

MARKER = "made_by"


def begin(folder):
    """Makes the folder, or empties it if this driver made it. Ends the driver if it holds anything else."""
    folder, driver = pathlib.Path(folder), pathlib.Path(sys.argv[0]).name
    marker = folder / MARKER
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())) and not (marker.is_file() and marker.read_text(encoding="utf-8").strip() == driver):
        sys.exit(f"{folder}: found files that {driver} did not make, expected a new folder, an empty one or one of its own")
    folder.mkdir(parents=True, exist_ok=True)
    marker.write_text(f"{driver}\n", encoding="utf-8")  # before anything is deleted: an interrupted call can be made again
    for child in folder.iterdir():
        if child.is_dir() and not child.is_symlink():
            shutil.rmtree(child)
        elif child != marker:
            child.unlink()
