"""Ask which vibration class a tool gets when a truck drives along the rear road."""

import trundle as tr


def main() -> list[str]:
    """Run 20 crossings and return the verdicts in words."""
    floor = tr.structure.reference_unit(mesh_size=2.0)
    truck = tr.vehicle.container_truck_40ft()
    rear = tr.route.Route.straight((0, 76.5), (52, 76.5), speed=15 / 3.6, name="rear")
    # waves to 22 cycle/m excite all bands to 80 Hz at this speed
    waves = tr.road.RoughnessBand(n_max=22.0, contact_patch=0.2)
    crossing = tr.simulate.Crossing(truck, rear, tr.road.RoadClass("B"), band=waves)
    runs = tr.simulate.ensemble(
        floor,
        crossing,
        method=tr.simulate.Coupled(),
        points={"tool": (32.5, 62.5)},
        n_runs=20,
        seed=1,
    )
    print(runs)
    return [str(verdict) for verdict in tr.criteria.assess(runs, tr.criteria.VC)]


if __name__ == "__main__":
    print("\n".join(main()))
