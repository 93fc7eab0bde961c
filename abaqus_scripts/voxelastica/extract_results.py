"""Reads the morphed mid-line and the reactions from an output database.

    abaqus python extract_results.py -- JOB.odb [--design DESIGN.json] [--out FOLDER] [--spoke N]

Writes JOB_midline.csv (what `voxelastica compare DIR --result` takes), JOB_reactions.csv and JOB_results.json.
"""

from __future__ import print_function

import argparse
import inspect
import os
import sys

# CAE runs scripts without __file__.
sys.path.insert(0, os.path.dirname(os.path.abspath(inspect.getfile(inspect.currentframe()))))  # type: ignore[arg-type]

from voxelastica_cae import script  # noqa: E402


def parser():
    # type: () -> argparse.ArgumentParser
    """The command line."""
    made = argparse.ArgumentParser(prog="extract_results.py", description="Reads an output database of a morph.")
    made.add_argument("odb", help="the job's output database")
    made.add_argument("--design", default="", help="design.json; its hash goes into the results")
    made.add_argument("--out", default="", help="folder of the results; default: that of the database")
    made.add_argument("--spoke", type=int, default=1, help="which spoke of a flower; default 1")
    return made


def main(arguments):
    # type: (list[str]) -> None
    """Extracts what the arguments ask for."""
    from voxelastica_cae.extract import extract

    given = parser().parse_args(arguments)
    extract(given.odb, given.design, given.out, given.spoke)


if __name__ == "__main__":
    script.run(main)
