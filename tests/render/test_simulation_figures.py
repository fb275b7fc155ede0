"""Figures of a simulation show its curves; turns lie one upon another."""

from __future__ import annotations

import numpy as np

import centrode as ct
from centrode.dynamics.simulation.results import simulation_results
from centrode.quantities import QUANTITIES
from drawn_curves import at_samples, heights_at
from simulated import pendulum, rotor


def test_every_curve_is_the_datasets() -> None:
    mechanism = rotor()
    results = simulation_results(mechanism, settings=ct.Simulation(driving="3 - v", duration=4, samples=81))
    data = results.simulation
    figures = ct.figures(results)
    assert list(figures) == ["simulation-speed", "simulation-phase", "simulation-energies"]
    shown = {
        ("simulation-speed", 0): ["drive_speed"],
        ("simulation-speed", 1): ["drive_acceleration"],
        ("simulation-speed", 2): ["driving_moment", "moment_of_loads"],
        ("simulation-energies", 0): ["kinetic_energy", "potential_energy"],
        ("simulation-energies", 1): ["work_of_drive", "work_of_friction", "work_of_other_loads"],
        ("simulation-energies", 2): ["energy_residual"],
    }
    for (name, panel), variables in shown.items():
        lines = {line.get_label(): line for line in figures[name].axes[panel].get_lines()}
        for variable in variables:
            line = lines[QUANTITIES[variable].title]
            np.testing.assert_array_equal(heights_at(line, data["time"]), data[variable])


def test_turns_lie_one_upon_another() -> None:
    mechanism = rotor()
    results = simulation_results(mechanism, settings=ct.Simulation(driving="3 - v", duration=8, samples=161))
    data = results.simulation
    line = ct.figures(results)["simulation-phase"].axes[0].get_lines()[0]
    places = np.asarray(line.get_xdata(), dtype=float)
    known = places[np.isfinite(places)]
    assert known.min() >= 0.0
    assert known.max() < 2 * np.pi
    # a gap at each new turn
    assert np.isnan(np.asarray(line.get_ydata(), dtype=float)).sum() == int(data.turned[-1] / (2 * np.pi))


def test_a_swing_is_one_curve() -> None:
    mechanism = pendulum()
    results = simulation_results(mechanism, settings=ct.Simulation(duration=3, samples=61))
    data = results.simulation
    line = ct.figures(results)["simulation-phase"].axes[0].get_lines()[0]
    np.testing.assert_array_equal(at_samples(line.get_xdata(), 61), data.drive_value[:, 0])


def test_the_figure_of_the_thesis() -> None:
    """Speed, gamma and psi over beta below each other, each on its own axis."""
    thesis = ct.example("spherical-crank-rocker")
    results = simulation_results(thesis, settings=ct.Simulation(driving="1", duration=3, samples=61))
    data = results.simulation
    axes = ct.figures(results)["simulation-angles"].axes
    beta = data.drive_value.to_numpy()[:, 0]
    gamma = np.degrees(np.arcsin(np.sin(np.pi / 12) * np.cos(beta) / np.sin(np.pi / 4)))
    psi = np.degrees(data.joint_angle.sel(joint="DC"))
    shown = (np.degrees(data.drive_speed), gamma, psi)
    assert len(axes) == len(shown)
    for one, values in zip(axes, shown, strict=True):
        heights = np.asarray(one.get_lines()[0].get_ydata(), dtype=float)
        places = np.asarray(one.get_lines()[0].get_xdata(), dtype=float)
        turned = np.degrees(beta % (2 * np.pi))
        for k in (0, 7, 60):
            near = np.nanargmin(np.abs(places - turned[k]) + np.abs(heights - float(values[k])))
            assert abs(heights[near] - float(values[k])) <= 1e-9 * float(np.abs(values).max())
    assert "simulation-angles" not in ct.figures(
        simulation_results(rotor(), settings=ct.Simulation(duration=1))
    )
