"""Ask which vibration class a tool gets when a truck drives along the rear road."""

import trundle as tr


def main() -> list[str]:
    """Run 20 crossings and return the verdicts in words."""
    floor = tr.structure.reference_unit(mesh_size=2.0)
    truck = tr.vehicle.container_truck_40ft()
    rear = tr.route.Route.straight((0, 76.5), (52, 76.5), speed=15 / 3.6, name="rear")
    crossing = tr.simulate.Crossing(vehicle=truck, route=rear, road=tr.road.RoadClass("B"))
    method = tr.simulate.Coupled(integration=tr.simulate.Modal(f_max=90, dt=0.005))
    runs = tr.simulate.ensemble(
        floor, crossing, method=method, points={"tool": (32.5, 62.5)}, n_runs=20, seed=1
    )
    print(runs)
    return [str(verdict) for verdict in tr.criteria.assess(runs, tr.criteria.VC, f_max=90)]


if __name__ == "__main__":
    print("\n".join(main()))
