"""Build a floor in OpenSeesPy with OpenSees's own elements, to hold trundle's results beside.

Only the floor's public data are used: nodes, held dofs, connectivity, sections and offsets. No
matrix of trundle's enters. What stands for what:

- shells: ``ASDShellQ4`` (MITC4 bending, enhanced membrane, drilling penalty at one point), whose
  own mass is lumped; so it is given none, and a ``ShellMITC4`` without stiffness (a thousand
  millionth) over it carries the mass consistently, as trundle's shell does;
- beams: ``ElasticTimoshenkoBeam`` with its consistent mass (``-cMass``);
- offsets: a beam has nodes of its own on its centroid line, each tied to its slab node by a
  massless beam ten thousand times as stiff as concrete; on the reference unit this changes
  frequencies by 2e-6 against rigid links. It is used because ``rigidLink`` with the
  ``Transformation`` handler loses track of a slave, in time integration, where its master is held
  in part, as it is on a mirror plane (see OpenSees's pull request 1785): an undamped floor then
  dies out. ``-jntOffset`` is no way out, for this beam ignores it;
- springs: ``zeroLength`` with elastic materials; point masses: ``mass``.

OpenSees has one model in each process; every function here wipes it and builds its own.
"""

import ctypes
import importlib
import importlib.util
from itertools import count
from pathlib import Path

import numpy as np

_LINK_STIFFNESS = 1e4 * 30e9  # Pa
_CARRIER = 1e-9  # share of the modulus in the shells that carry nothing but mass
_WHEEL_LIBRARIES = ("libquadmath.so.0", "libgfortran.so.4", "libblas.so.3")


def load_opensees():
    """Import OpenSeesPy, or raise ImportError.

    The Linux wheel brings its own BLAS but does not say where; a library loaded by its path is
    found by its name afterwards, so that nobody has to set LD_LIBRARY_PATH.
    """
    spec = importlib.util.find_spec("openseespylinux")
    try:
        if spec is not None and spec.submodule_search_locations:
            folder = Path(spec.submodule_search_locations[0]) / "lib"
            for name in _WHEEL_LIBRARIES:
                if (folder / name).exists():
                    ctypes.CDLL(str(folder / name))
        return importlib.import_module("openseespy.opensees")
    except (OSError, RuntimeError) as error:  # the package turns its ImportError into the latter
        raise ImportError(str(error)) from error


def frequencies(floor, n_modes):
    """Return the first natural frequencies [Hz] and their shapes, (n_nodes, 6, n_modes)."""
    ops = load_opensees()
    _build(ops, floor)
    _use_direct_solver(ops)
    omega2 = np.array(ops.eigen("-genBandArpack", n_modes))
    shapes = np.array(
        [
            [ops.nodeEigenvector(node + 1, mode + 1) for mode in range(n_modes)]
            for node in range(len(floor.nodes))
        ]
    )
    ops.wipe()
    return np.sqrt(omega2) / (2 * np.pi), shapes.transpose(0, 2, 1)


def hat_loads(floor, *, start, end, speed, dt, n_steps):
    """Spread a unit force that moves along a line of nodes over them by hat functions.

    The force is at the foot of the first hat, one element before `start`, at time 0, and the last
    hat ends one element after `end`.

    Returns
    -------
    nodes : ndarray of int, shape (n_line,)
    shares : ndarray of float, shape (n_steps + 1, n_line)
    ramp : float
        Length of the element before the start [m].
    """
    start, end = np.append(start, 0.0), np.append(end, 0.0)
    length = np.linalg.norm(end - start)
    along = (end - start) / length
    station = (floor.nodes - start) @ along
    beside = np.linalg.norm(floor.nodes - start - station[:, None] * along, axis=1)
    on_line = (beside < 1e-6) & (station > -1e-6) & (station < length + 1e-6)
    nodes = np.flatnonzero(on_line)[np.argsort(station[on_line])]
    feet = station[nodes]
    assert abs(feet[0]) < 1e-6, "the route starts at no node"
    assert abs(feet[-1] - length) < 1e-6, "the route ends at no node"
    ramp = feet[1] - feet[0]
    feet = np.concatenate([[-ramp], feet, [2 * feet[-1] - feet[-2]]])
    place = -ramp + speed * dt * np.arange(n_steps + 1)
    hats = np.eye(len(feet))[:, 1:-1]
    return nodes, np.stack([np.interp(place, feet, hat) for hat in hats.T], axis=1), ramp


def accelerations(floor, loads, *, dt, damping, read_at):
    """Integrate the floor from rest by Newmark's average acceleration.

    Parameters
    ----------
    floor : Floor
    loads : tuple of (nodes, forces)
        Node numbers and downward forces on them [N], shape (n_steps + 1, n_loaded).
    dt : float
    damping : Rayleigh
        On the whole floor; beta stands on the stiffness of the last committed state, which in a
        linear floor is the stiffness, and costs least.
    read_at : sequence of int
        Node numbers.

    Returns
    -------
    ndarray of float, shape (n_steps + 1, n_read)
        Vertical accelerations [m/s2].
    """
    ops = load_opensees()
    carriers = _build(ops, floor)
    _load_nodes(ops, *loads, dt)
    ops.rayleigh(damping.alpha, 0.0, 0.0, 0.0)
    stiff = [tag for tag in ops.getEleTags() if tag not in carriers]
    ops.region(1, "-ele", *stiff, "-rayleigh", damping.alpha, 0.0, 0.0, damping.beta)
    _use_direct_solver(ops)
    ops.algorithm("Linear", "-factorOnce")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    history = np.zeros((len(loads[1]), len(read_at)))
    for step in range(1, len(history)):
        if ops.analyze(1, dt) != 0:
            raise RuntimeError(f"OpenSees failed at step {step}")
        history[step] = [ops.nodeAccel(int(node) + 1, 3) for node in read_at]
    ops.wipe()
    return history


def _use_direct_solver(ops):
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("SparseGEN")


def _load_nodes(ops, nodes, forces, dt):
    for number, (node, force) in enumerate(zip(nodes, forces.T, strict=True), start=1):
        ops.timeSeries("Path", number, "-dt", dt, "-values", *force.tolist())
        ops.pattern("Plain", number, number)
        ops.load(int(node) + 1, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0)


def _build(ops, floor):
    """Build the floor and return the tags of the elements that only carry mass."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    held = floor.dof_index < 0  # by a support, or because no element is there
    for number, (place, fixed) in enumerate(zip(floor.nodes, held, strict=True), start=1):
        ops.node(number, *place.tolist())
        if fixed.any():
            ops.fix(number, *fixed.astype(int).tolist())
    elements, nodes = count(1), count(len(floor.nodes) + 1)
    carriers = _add_shells(ops, floor, elements)
    _add_beams(ops, floor, elements, nodes)
    _add_springs(ops, floor, elements, nodes)
    _add_masses(ops, floor)
    return carriers


def _add_shells(ops, floor, elements):
    sections, carriers = count(1), set()
    for group in floor.shells:
        section, material = group.section, group.section.material
        stiff, heavy = next(sections), next(sections)
        modulus, nu, t = material.elastic_modulus, material.poisson_ratio, section.thickness
        plate = "ElasticMembranePlateSection"
        ops.section(plate, stiff, modulus, nu, t, 0.0)
        ops.section(plate, heavy, _CARRIER * modulus, nu, t, section.mass_per_area / t)
        for corners in (group.elements + 1).tolist():
            ops.element("ASDShellQ4", next(elements), *corners, stiff)
            carrier = next(elements)
            ops.element("ShellMITC4", carrier, *corners, heavy)
            carriers.add(carrier)
    return carriers


def _add_beams(ops, floor, elements, nodes):
    transforms, centroids = count(1), {}
    for group in floor.beams:
        s, m = group.section, group.section.material
        properties = (
            m.elastic_modulus, m.shear_modulus, s.area, s.torsion_constant, s.inertia_y,
            s.inertia_z, s.shear_area_y, s.shear_area_z,
        )  # fmt: skip
        for ends in group.elements:
            tags = [
                _centroid_node(
                    ops, floor, node, group.offset, centroids, elements, nodes, transforms
                )
                for node in ends.tolist()
            ]
            transform = _transform(
                ops, floor.nodes[ends[1]] - floor.nodes[ends[0]], group.up, transforms
            )
            mass = ("-mass", m.density * s.area, "-cMass")
            ops.element(
                "ElasticTimoshenkoBeam", next(elements), *tags, *properties, transform, *mass
            )


def _centroid_node(ops, floor, node, offset, centroids, elements, nodes, transforms):
    """Return the tag of a node on the beam's centroid, with its link where it is a new one."""
    if not offset.any():
        return node + 1
    key = (node, *offset.tolist())
    if key not in centroids:
        tag = centroids[key] = next(nodes)
        ops.node(tag, *(floor.nodes[node] + offset).tolist())
        transform = _transform(ops, offset, np.eye(3)[np.argmin(np.abs(offset))], transforms)
        stiff = (_LINK_STIFFNESS, _LINK_STIFFNESS, *(1.0,) * 6)
        ops.element("ElasticTimoshenkoBeam", next(elements), node + 1, tag, *stiff, transform)
    return centroids[key]


def _transform(ops, along, up, transforms):
    """State a member's frame: local z is the part of `up` across it, or of x where it stands."""
    tag = next(transforms)
    parallel = np.linalg.norm(np.cross(along, up)) < 1e-6 * np.linalg.norm(along)
    ops.geomTransf("Linear", tag, *((1.0, 0.0, 0.0) if parallel else up.tolist()))
    return tag


def _add_springs(ops, floor, elements, nodes):
    materials = count(1)
    for group in floor.springs:
        tags, directions = [], []
        for direction in np.flatnonzero(group.stiffness).tolist():
            tags.append(next(materials))
            directions.append(direction + 1)
            ops.uniaxialMaterial("Elastic", tags[-1], float(group.stiffness[direction]))
        for first, second in group.elements.tolist():
            other = second + 1
            if second < 0:  # rigid ground
                other = next(nodes)
                ops.node(other, *floor.nodes[first].tolist())
                ops.fix(other, *(1,) * 6)
            ops.element(
                "zeroLength", next(elements), first + 1, other, "-mat", *tags, "-dir", *directions,
                "-doRayleigh", 1,
            )  # fmt: skip


def _add_masses(ops, floor):
    total = np.zeros(len(floor.nodes))
    for group in floor.masses:
        np.add.at(total, group.nodes, group.mass)
    for node in np.flatnonzero(total).tolist():
        ops.mass(node + 1, *(float(total[node]),) * 3, 0.0, 0.0, 0.0)
