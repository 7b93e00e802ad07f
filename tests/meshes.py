"""Write meshes of a plate with a beam as gmsh does, in both of its formats: read by the tests."""

import numpy as np


def plate_mesh(nx, ny, lx=6.0, ly=4.0, triangles=False, z=0.0):
    """Return nodes, and elements by group and dimension: a plate, its edge, a beam, a corner."""
    x, y = np.meshgrid(np.linspace(0, lx, nx + 1), np.linspace(0, ly, ny + 1), indexing="ij")
    nodes = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, z)])
    number = np.arange(x.size).reshape(x.shape)
    quads = np.stack(
        [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1
    ).reshape(-1, 4)
    if triangles:
        quads = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    sides = (number[:, 0], number[:, -1], number[0, :], number[-1, :])
    edge = np.concatenate([np.column_stack([s[:-1], s[1:]]) for s in sides])
    middle = number[:, ny // 2]
    return nodes, {
        (2, 1, "slab"): quads,
        (1, 2, "edge"): edge,
        (1, 3, "beam"): np.column_stack([middle[:-1], middle[1:]]),
        (0, 4, "corner"): number[:1, :1],
    }


KINDS = {1: 15, 2: 1, 3: 2, 4: 3}


def as_msh_2(nodes, groups):
    """Format 2.2: node numbers with gaps, and in falling order."""
    tags = 10 + 3 * np.arange(len(nodes))[::-1]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {number} "{name}"' for dimension, number, name in groups]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{t} {a!r} {b!r} {c!r}" for t, (a, b, c) in zip(tags, nodes.tolist(), strict=True)]
    lines += ["$EndNodes", "$Elements", str(sum(map(len, groups.values())))]
    n = 0
    for (_, number, _), elements in groups.items():
        for element in elements:
            n += 1
            corners = " ".join(str(tags[i]) for i in element)
            lines.append(f"{n} {KINDS[len(element)]} 2 {number} 1 {corners}")
    return "\n".join([*lines, "$EndElements"]) + "\n"


def as_msh_4(nodes, groups):
    """Format 4.1: an entity a group, all nodes in two blocks."""
    count = [sum(d == k for d, _, _ in groups) for k in range(4)]
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {number} "{name}"' for dimension, number, name in groups]
    lines += ["$EndPhysicalNames", "$Entities", " ".join(map(str, count))]
    for dimension, number, _ in sorted(groups):
        box = "0 0 0" if dimension == 0 else "0 0 0 1 1 1"
        lines.append(f"{20 + number} {box} 1 {number} " + ("0" if dimension else ""))
    half = len(nodes) // 2
    lines += ["$EndEntities", "$Nodes", f"2 {len(nodes)} 1 {len(nodes)}"]
    for first, last in ((0, half), (half, len(nodes))):
        lines.append(f"2 21 0 {last - first}")
        lines += [str(1 + i) for i in range(first, last)]
        lines += [f"{a!r} {b!r} {c!r}" for a, b, c in nodes[first:last].tolist()]
    total = sum(map(len, groups.values()))
    lines += ["$EndNodes", "$Elements", f"{len(groups)} {total} 1 {total}"]
    n = 0
    for (dimension, number, _), elements in groups.items():
        lines.append(f"{dimension} {20 + number} {KINDS[elements.shape[1]]} {len(elements)}")
        for element in elements:
            n += 1
            lines.append(f"{n} " + " ".join(str(1 + i) for i in element) + " ")
    return "\n".join([*lines, "$EndElements"]) + "\n"
