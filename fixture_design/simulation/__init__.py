"""Simulations in Drake, for evaluation: an assembly with its contacts, a robot with an impedance, a wrist sensor.

`planar_world` is the plant, `true_state` what touches in it, `systems` the sensor and recognition as Drake systems (the
latter for any diagram), `simulation` a run. `insertion` closes the loop: `belief` of where the fixed parts are, from
the states that recognition leaves, a `plan` through the graph, and the hybrid control sets of the state;
`fixed_compliance` is what it is compared with, in `trials`. `grasp_shake` turns a grasp until gravity has pulled in six
directions. Drake is loaded when a simulation is made.
"""

from fixture_design.simulation.belief import Belief
from fixture_design.simulation.fixed_compliance import FixedCompliance
from fixture_design.simulation.insertion import ClosedLoop, Pace
from fixture_design.simulation.plan import Leg, Plan, Wanted, corner_first, plan_of
from fixture_design.simulation.setup import Robot, Setup, Surfaces, WristSensor
from fixture_design.simulation.simulation import Controller, Run, Sample, Simulation
from fixture_design.simulation.systems import recognition_system
from fixture_design.simulation.trials import Outcome, Trial, closed_loop, insert, straight_down, without_looking

__all__ = [
    "Belief",
    "ClosedLoop",
    "Controller",
    "FixedCompliance",
    "Leg",
    "Outcome",
    "Pace",
    "Plan",
    "Robot",
    "Run",
    "Sample",
    "Setup",
    "Simulation",
    "Surfaces",
    "Trial",
    "Wanted",
    "WristSensor",
    "closed_loop",
    "corner_first",
    "insert",
    "plan_of",
    "recognition_system",
    "straight_down",
    "without_looking",
]
