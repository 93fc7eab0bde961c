"""What scripts without windows share: their arguments and how they end."""

from __future__ import print_function

import sys

from . import VoxelasticaError, messages


def arguments(argv):
    # type: (list[str]) -> list[str]
    """The script's own arguments: `abaqus cae noGUI=x.py -- A B` leaves more before the two dashes than Python does."""
    return argv[len(argv) - argv[::-1].index("--") :] if "--" in argv else argv[1:]


def run(main):
    """Runs a script; wrong input ends it with a message and status 2."""
    messages.terminal = True
    try:
        main(arguments(sys.argv))
    except VoxelasticaError as error:
        messages.refuse(error)
        sys.exit(2)
