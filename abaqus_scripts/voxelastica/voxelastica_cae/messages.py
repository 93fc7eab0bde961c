"""Messages to the user: CAE's message area, or the terminal where there is none."""

from __future__ import print_function

import sys

#: Set by scripts that run without the graphical interface, where CAE swallows what is printed.
terminal = False


def say(text):
    """Prints a line into CAE's message area, and to the terminal in a run without windows."""
    print(text)
    if terminal and sys.stdout is not sys.__stdout__:
        sys.__stdout__.write(text + "\n")
        sys.__stdout__.flush()


def refuse(error):
    """Says what is wrong with the user's input."""
    say("Voxelastica: %s" % error)
