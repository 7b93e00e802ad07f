"""Read plans from DXF drawings: lines, outlines and places, layer by layer.

ezdxf reads the file; this is the only module that knows it. Blocks are taken apart, arcs become
lines, and what is not understood is counted, layer by layer, for whoever asks.
"""

# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
# pyright: reportUnknownVariableType=false, reportUnknownArgumentType=false
from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError
from trundle.structure.mesh.polygons import rings_of

__all__ = ["Drawing", "Shape", "read_drawing"]

_UNITS = {1: 0.0254, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0, 14: 0.1}  # $INSUNITS in metres
_LARGEST = 50_000_000  # bytes
_MOST = 200_000  # shapes
_SAG = 5e-3  # m, by which a line may cut an arc short
_CURVES = {"LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE"}
_CLOSED = 1e-4  # m


@dataclass(frozen=True, kw_only=True, eq=False)
class Shape:
    """Hold a line, an outline or a place of a drawing.

    Attributes
    ----------
    points : ndarray of float, shape (n, 2)
        Corners, the first not repeated where it is closed; one for a place [m].
    closed : bool
        Whether it is an outline.
    centre : ndarray of float, shape (2,)
        Its middle [m].
    """

    points: Float[Array, "corners 2"]
    closed: bool
    centre: Float[Array, " 2"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Drawing:
    """Hold what a drawing shows.

    Attributes
    ----------
    layers : mapping of str to tuple of Shape
        Shapes by layer.
    left_out : mapping of (str, str) to int
        How many of which kind on which layer were not understood.
    """

    layers: Mapping[str, tuple[Shape, ...]]
    left_out: Mapping[tuple[str, str], int]

    def outlines(self, layer: str) -> list[Float[Array, "_ 2"]]:
        """Return the outlines of a layer, those that lines and arcs enclose together too."""
        shapes = self.layers.get(layer, ())
        closed = [shape.points for shape in shapes if shape.closed]
        return closed + rings_of([s.points for s in shapes if not s.closed and len(s.points) > 1])


def read_drawing(path: Path, *, unit: float | None, origin: tuple[float, float]) -> Drawing:
    """Read the model space of a DXF drawing.

    Parameters
    ----------
    path : Path
        The file.
    unit : float or None
        Its unit [m]; None where the drawing says it.
    origin : tuple of float
        Place of the drawing, in metres, that is x = y = 0.

    Raises
    ------
    InputError
        No drawing, none of a readable size, or one that does not say its unit.
    """
    document = _document(path)
    scale = unit if unit is not None else _UNITS.get(int(document.header.get("$INSUNITS", 0)))
    if scale is None:
        raise InputError(f'{path.name} does not say its unit: state it, such as unit = "mm"')
    found: dict[str, list[Shape]] = {}
    left: Counter[tuple[str, str]] = Counter()
    for n, (layer, entity) in enumerate(_entities(document)):
        if n > _MOST:
            raise InputError(f"{path.name} holds more than {_MOST} shapes: save the plan alone")
        shape = _shape(entity, scale, np.array(origin))
        if shape is None:
            left[layer, entity.dxftype()] += 1
        else:
            found.setdefault(layer, []).append(shape)
    layers = {layer: tuple(shapes) for layer, shapes in found.items()}
    return Drawing(layers=layers, left_out=dict(left))


def _document(path: Path) -> Any:  # noqa: ANN401 - ezdxf's
    from ezdxf import recover  # noqa: PLC0415 - a third of a second, for drawings alone

    log = logging.getLogger("ezdxf")  # says what it mends of a file, in its own words
    level = log.level
    log.setLevel(logging.CRITICAL + 1)
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(
                f"{path.name} is larger than {_LARGEST // 10**6} MB: save the plan alone"
            )
        document, _ = recover.readfile(path)
    except InputError:
        raise
    except OSError as error:
        raise InputError(f"{path.name} cannot be read: {error.strerror or error}") from None
    except Exception:  # ezdxf raises many unrelated types on what is no drawing
        raise InputError(f"{path.name} is no DXF drawing that can be read") from None
    finally:
        log.setLevel(level)
    return document


def _entities(
    document: Any,  # noqa: ANN401 - ezdxf's
) -> Iterator[tuple[str, Any]]:
    """Give everything in model space with its layer, blocks taken apart."""
    from ezdxf import disassemble  # noqa: PLC0415 - with its document

    for entity in document.modelspace():
        if entity.dxftype() != "INSERT":
            yield entity.dxf.layer, entity
            continue
        for part in disassemble.recursive_decompose([entity]):
            # what a block has on layer 0 lies on the layer that the block is inserted on
            yield (entity.dxf.layer if part.dxf.layer == "0" else part.dxf.layer), part


def _shape(
    entity: Any,  # noqa: ANN401 - ezdxf's
    scale: float,
    origin: Array,
) -> Shape | None:
    """Return an entity as a shape in metres; None for what is not understood."""
    from ezdxf import path  # noqa: PLC0415 - with its document

    kind = entity.dxftype()
    if kind == "POINT":
        place = np.array([entity.dxf.location.x, entity.dxf.location.y]) * scale - origin
        return Shape(points=place[None], closed=False, centre=place)
    if kind not in _CURVES:
        return None
    try:
        vertices = list(path.make_path(entity).flattening(_SAG / scale))
    except Exception:  # a curve without a length, a spline without knots
        return None
    points = np.array([[v.x, v.y] for v in vertices], dtype=float) * scale - origin
    if len(points) < 2 or not np.isfinite(points).all():
        return None
    closed = len(points) > 3 and np.hypot(*(points[-1] - points[0])) < _CLOSED
    points = points[:-1] if closed else points
    return Shape(points=points, closed=bool(closed), centre=points.mean(axis=0))
