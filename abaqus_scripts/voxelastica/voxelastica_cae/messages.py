"""Messages to the user: CAE's message area, or the terminal where there is none."""

from __future__ import print_function

import sys

#: Set by scripts that run without the graphical interface, where CAE swallows what is printed.
terminal = False


def say(text):
    """Prints a line into CAE's message area, and to the terminal in a run without windows."""
    print(text)
    original = sys.__stdout__
    if terminal and original is not None and sys.stdout is not original:
        original.write(text + "\n")
        original.flush()


def refuse(error):
    """Says what is wrong with the user's input."""
    say("Voxelastica: %s" % error)


def progress(message, things, done, total):
    # type: (str, str, int, int) -> None
    """Moves CAE's progress bar: `done` of `total` things. Work does not depend on it."""
    try:
        from abaqus import milestone  # pyright: ignore[reportAttributeAccessIssue]  not in the stub of this module
    except ImportError:
        return
    milestone(message, things, done, total)
