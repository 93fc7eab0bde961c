"""Builds a model from a design without windows.

abaqus cae noGUI=build_model.py -- DESIGN.json [--kind auto|geometry|mesh|shell] [--model NAME] [--job NAME]
    [--cores N] [--memory N --memory-unit percent|mb|gb] [--no-mesh] [--find auto|planes|runs]
    [--save FILE.cae] [--write-input] [--estimate]
"""

from __future__ import print_function

import argparse
import inspect
import os
import sys

# CAE runs scripts without __file__.
sys.path.insert(0, os.path.dirname(os.path.abspath(inspect.getfile(inspect.currentframe()))))  # type: ignore[arg-type]

from voxelastica_cae import VoxelasticaError, design, estimate, script  # noqa: E402
from voxelastica_cae.messages import say  # noqa: E402


def parser():
    # type: () -> argparse.ArgumentParser
    """The command line."""
    made = argparse.ArgumentParser(prog="build_model.py", description="Builds a model from a Voxelastica design.")
    made.add_argument("design", help="design.json of a design's folder")
    made.add_argument("--kind", default="auto", choices=("auto", "geometry", "mesh", "shell"))
    made.add_argument("--model", default="", help="name of the model; default: the design's and the kind")
    made.add_argument("--job", default="", help="name of the job; default: the model's")
    made.add_argument("--cores", type=int, default=1)
    made.add_argument("--memory", type=int, default=90)
    made.add_argument("--memory-unit", default="percent", choices=("percent", "mb", "gb"))
    made.add_argument("--no-mesh", action="store_true", help="leave the meshing of geometry to you")
    made.add_argument("--find", default="auto", choices=("auto", "planes", "runs"), help="how cells are looked up")
    made.add_argument("--save", default="", help="save the database under this name")
    made.add_argument("--write-input", action="store_true", help="write the job's input file")
    made.add_argument("--estimate", action="store_true", help="say how large the model would be, and stop")
    return made


def main(arguments):
    # type: (list[str]) -> None
    """Builds what the arguments ask for."""
    given = parser().parse_args(arguments)
    if given.estimate:
        chosen = design.read(given.design)
        size, mesh = estimate.geometry(chosen), estimate.mesh(chosen)
        say("geometry: %(cells)d cells, %(cuts)d cuts, %(questions)d questions" % size)
        say("mesh: %(elements)d elements, about %(nodes)d nodes" % mesh)
        say("recommended: %s, because %s" % estimate.recommend(chosen))
        return
    from abaqus import mdb
    from voxelastica_cae.build import Options, build

    options = Options(
        kind=given.kind,
        model=given.model,
        job=given.job,
        cores=given.cores,
        memory=given.memory,
        memory_unit=given.memory_unit,
        mesh=not given.no_mesh,
        find=given.find,
        write_input=given.write_input,
    )
    build(given.design, options)
    if given.save:
        try:
            mdb.saveAs(pathName=given.save)
        except Exception as error:
            raise VoxelasticaError("%s was not saved: %s" % (given.save, error))


if __name__ == "__main__":
    script.run(main)
