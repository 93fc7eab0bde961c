# SPDX-License-Identifier: GPL-3.0-or-later
"""The library's messages as they are said in a panel: the same words, without the command line's options."""

from __future__ import annotations

import re

_OPTIONS = (
    (r"^design: ", ""),
    (r",? or (ask for it|insist) with --yes", ""),
    (r"(Name the right program|name it) with --ccx( PATH)?", r"\1 in the add-on's preferences"),
    (r" with -o\b", ""),
)


def said(error: BaseException) -> str:
    """What an error says."""
    text = str(error)
    for option, instead in _OPTIONS:
        text = re.sub(option, instead, text)
    return text
