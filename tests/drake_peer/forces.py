"""Contact forces of Drake, printed as JSON; runs in the environment that has Drake."""

from __future__ import annotations

import json
import sys
from typing import Any

import numpy as np
from pydrake import all as drake
from states import DISSIPATION, MASS, RADIUS, STIFFNESS, State


def material(*, is_rigid: bool = False) -> Any:
    """Returns the properties of a surface; two equal surfaces have half the stiffness of one."""
    properties = drake.ProximityProperties()
    stiffness = 1e300 if is_rigid else STIFFNESS
    smooth = drake.CoulombFriction(0.0, 0.0)
    drake.AddContactMaterial(
        dissipation=DISSIPATION, point_stiffness=stiffness, friction=smooth, properties=properties
    )
    return properties


class Pair:
    """Sphere ``b`` and a fixed plane or a free sphere ``a``, without gravity, in a continuous plant."""

    def __init__(self, on: str) -> None:
        builder = drake.DiagramBuilder()
        self.plant, _ = drake.AddMultibodyPlantSceneGraph(builder, time_step=0.0)
        self.plant.set_contact_model(drake.ContactModel.kPoint)
        self.plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
        self.bodies = [self.ball("b")]
        if on == "sphere":
            self.bodies.append(self.ball("a"))
        else:
            self.plant.RegisterCollisionGeometry(
                self.plant.world_body(),
                drake.RigidTransform(),
                drake.HalfSpace(),
                "a",
                material(is_rigid=True),
            )
        self.plant.Finalize()
        self.diagram = builder.Build()

    def ball(self, name: str) -> Any:
        inertia = drake.SpatialInertia(MASS, np.zeros(3), drake.UnitInertia.SolidSphere(RADIUS))
        body = self.plant.AddRigidBody(name, inertia)
        sphere = drake.Sphere(RADIUS)
        self.plant.RegisterCollisionGeometry(body, drake.RigidTransform(), sphere, name, material())
        return body

    def context(self, state: State) -> tuple[Any, Any]:
        """Returns the contexts of the diagram and of the plant at a state."""
        whole = self.diagram.CreateDefaultContext()
        own = self.plant.GetMyMutableContextFromRoot(whole)
        for body, place in zip(self.bodies, (state.place, [0.0, 0.0, 0.0]), strict=False):
            self.plant.SetFreeBodyPose(own, body, drake.RigidTransform(place))
        velocity = drake.SpatialVelocity(w=state.angular, v=state.linear)
        self.plant.SetFreeBodySpatialVelocity(self.bodies[0], velocity, own)
        return whole, own

    def force(self, state: State) -> list[float]:
        """Returns the force on ``b``, N, axes of W."""
        _, own = self.context(state)
        results = self.plant.get_contact_results_output_port().Eval(own)
        if results.num_point_pair_contacts() == 0:
            return [0.0, 0.0, 0.0]
        info = results.point_pair_contact_info(0)
        # contact_force acts on the second body of the pair
        sign = 1.0 if info.bodyB_index() == self.bodies[0].index() else -1.0
        return [float(sign * x) for x in info.contact_force()]

    def after(self, state: State, duration: float) -> list[float]:
        """Returns the velocity of ``b``, m/s, after `duration`, s."""
        whole, own = self.context(state)
        simulator = drake.Simulator(self.diagram, whole)
        drake.ResetIntegratorFromFlags(simulator, "runge_kutta5", 1e-4)
        simulator.get_mutable_integrator().set_target_accuracy(1e-12)
        simulator.AdvanceTo(duration)
        return [
            float(x) for x in self.plant.EvalBodySpatialVelocityInWorld(own, self.bodies[0]).translational()
        ]


def main() -> None:
    """Reads states and an impact from the standard input, and prints the forces and the last velocity."""
    asked = json.load(sys.stdin)
    states = [State(**values) for values in asked["states"]]
    pairs = {on: Pair(on) for on in ("sphere", "plane")}
    forces = [pairs[state.on].force(state) for state in states]
    impact = pairs["sphere"].after(State(**asked["impact"]), asked["duration"])
    json.dump({"forces": forces, "impact": impact}, sys.stdout)


main()
