"""Materials and the keys of the design file, from which hosts build their forms."""

from __future__ import annotations

import json
from typing import Any

from ._call import text


def materials() -> list[dict[str, Any]]:
    """The library's materials: name, ``modulus_mpa``, ``poisson`` and what else is known of each."""
    return json.loads(text("materials_json"))


def parameters() -> list[dict[str, Any]]:
    """All keys of the design file, in its order.

    Each has ``key``, ``type`` with its range (``least``, ``most``, ``choices`` ...), ``unit``, ``default`` (JSON text or
    ``None``), ``required``, ``targets`` (kinds of targets it applies to; empty: all) and ``description``.
    """
    return json.loads(text("parameters_json"))


def schema() -> dict[str, Any]:
    """JSON Schema of the design file."""
    return json.loads(text("parameters_schema"))
