"""Multibody systems: closed forms, conservation laws, forward against inverse dynamics, loops."""

import math
import unittest

import launchdyn as ld
import numpy as np
from support import Case

G = 9.81
Z = (0, 0, 1)


def pendulum(**more):
    """A point mass of 2 kg, 0.7 m below its hinge at rest, angle from there."""
    return ld.Body("bob", hinge="revolute", axis=Z, mass=2, center=(0, -0.7, 0), **more)


def double():
    """Two point masses, unequal: 3 kg at 0.5 m, 1.2 kg at 0.8 m."""
    return ld.Multibody([
        ld.Body("upper", hinge="revolute", axis=Z, mass=3, center=(0, -0.5, 0)),
        ld.Body("lower", "upper", "revolute", at=(0, -0.5, 0), axis=Z, mass=1.2,
                center=(0, -0.8, 0))])


def top():
    """A spinning body on a spherical hinge and a rod on a universal one at its tip."""
    return ld.Multibody([
        ld.Body("top", hinge="spherical", mass=1.5, center=(0.1, 0.3, -0.2),
                inertia=(0.02, 0.03, 0.04, 0.001, 0.002, -0.003)),
        ld.Body("rod", "top", "universal", at=(0, 0.6, 0), axis=(1, 0, 0), axis_2=Z, mass=0.4,
                center=(0, 0.2, 0.1), inertia=(0.01, 0.002, 0.01))])


def four_bar(**more):
    """A four-bar with cranks of 1 and 1.5 m, 2 m apart, coupler of 1.8 m."""
    def rod(name, length, **more):
        return ld.Body(name, hinge="revolute", axis=Z, mass=length, center=(length / 2, 0, 0),
                       inertia=(0, length**3 / 12, length**3 / 12), **more)
    return ld.Multibody([rod("crank", 1.0), rod("coupler", 1.8, parent="crank", at=(1, 0, 0)),
                         rod("rocker", 1.5, at=(2, 0, 0))],
                        [ld.LoopJoint("pin", "coupler", "rocker", "revolute",
                                      first_at=(1.8, 0, 0), second_at=(1.5, 0, 0), axis=Z, **more)])


class TestMultibody(Case):
    def test_pendulum_has_the_period_of_the_elliptic_integral(self):
        system, amplitude = ld.Multibody([pendulum()]), 2.0
        a, b = 1.0, math.cos(amplitude / 2)
        while abs(a - b) > 1e-15:
            a, b = (a + b) / 2, math.sqrt(a * b)
        period = 2 * math.pi * math.sqrt(0.7 / G) / a
        motion = system.integrate([amplitude], [0], period, output_step=period / 2, tolerance=1e-11)
        self.near("pendulum: half and whole period [rad]", motion.q[:, 0],
                  [amplitude, -amplitude, amplitude], 4e-11)
        np.testing.assert_allclose(motion.t, [0, period / 2, period], rtol=1e-15)

    def test_vibrations_of_a_double_pendulum(self):
        m, n, a, b = 3, 1.2, 0.5, 0.8
        mass = np.array([[(m + n) * a * a, n * a * b], [n * a * b, n * b * b]])
        stiffness = np.diag([(m + n) * G * a, n * G * b])  # in absolute angles
        expected = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)))) / math.tau
        found = double().vibration([0, 0])
        self.near("double pendulum: frequencies, relative", [mode.frequency for mode in found],
                  expected, 1e-12, relative=True)
        for mode in found:
            absolute = np.cumsum(mode.shape)
            left = stiffness @ absolute
            np.testing.assert_allclose((math.tau * mode.frequency)**2 * mass @ absolute, left,
                                       atol=1e-8 * abs(left).max())

    def test_spring_damper_and_wrench_act(self):
        system = ld.Multibody([pendulum(stiffness=[5.0], damping=[0.3], rest=[0.2])])
        expected = (-2 * G * 0.7 * math.sin(0.5) - 5 * 0.3 - 0.3 * 1.1 + 4 - 2.5) / (2 * 0.49)
        found = system.accelerations([0.5], [1.1], tau=[4], wrench=[[0, 0, 0, 0, 0, -2.5]])
        np.testing.assert_allclose(found, [expected], rtol=1e-13)
        self.assertAlmostEqual(system.energy([0.5], [0]).elastic, 2.5 * 0.09, 14)

    def test_inverse_dynamics_undo_forward_dynamics(self):
        system, draw = top(), np.random.default_rng(3)
        q = np.array([*(draw.normal(size=4)), 0.4, -0.7])
        q[:4] /= np.linalg.norm(q[:4])
        u, tau, wrench = draw.normal(size=5), draw.normal(size=5), draw.normal(size=(2, 6))
        found = system.forces(q, u, system.accelerations(q, u, tau, wrench), wrench)
        self.near("inverse of forward dynamics [N m]", found, tau, 4e-15)

    def test_energy_and_momentum_about_the_vertical_stay(self):
        system = top()
        motion = system.integrate(system.reference, [1, 7, -2, 0.5, 0.3], 1.0, output_step=0.25,
                                  tolerance=1e-10)
        energies = [sum(system.energy(q, u)) for q, u in zip(motion.q, motion.u)]
        about = [system.momentum(q, u)[1][1] for q, u in zip(motion.q, motion.u)]
        self.near("top and rod: energy [J]", energies, np.full(5, energies[0]), 5e-10)
        self.near("their momentum about the vertical [kg m2/s]", about, np.full(5, about[0]), 2e-11)
        self.assertGreater(np.ptp([system.energy(q, u).kinetic
                                   for q, u in zip(motion.q, motion.u)]), 0.1)

    def test_places_move_as_their_velocities(self):
        system, h = top(), 1e-5
        u, at = np.array([1, 2, -1, 0.5, 0.3]), (0.1, 0.2, 0.3)
        motion = system.integrate(system.reference, u, 2 * h, output_step=h, tolerance=1e-12)
        before, now, after = (system.locate("rod", q, v, at)
                              for q, v in zip(motion.q, motion.u))
        np.testing.assert_allclose((after.position - before.position) / (2 * h), now.velocity,
                                   atol=1e-7)
        self.assertGreater(np.linalg.norm(now.velocity), 1)
        self.assertAlmostEqual(np.linalg.norm(now.attitude), 1, 12)

    def test_a_loop_is_closed_and_stays_so(self):
        system = four_bar()
        q, u, found = system.assemble([1.2, -1.0, 1.8], [2, 0, 0], kept=["crank"])
        self.assertEqual((q[0], u[0], found.freedoms, found.held, found.redundant),
                         (1.2, 2.0, 1, 2, 3))
        motion = system.integrate(q, u, 0.5, output_step=0.1, tolerance=1e-10)
        for at in zip(motion.q, motion.u):
            ends = (system.locate("coupler", *at, (1.8, 0, 0)),
                    system.locate("rocker", *at, (1.5, 0, 0)))
            np.testing.assert_allclose(ends[0].position, ends[1].position, atol=1e-12)
            np.testing.assert_allclose(ends[0].velocity, ends[1].velocity, atol=1e-11)
        energies = [sum(system.energy(*at)) for at in zip(motion.q, motion.u)]
        self.assertLess(np.ptp(energies), 1e-7)

    def test_springs_and_dampers_of_loops(self):
        system, h = four_bar(stiffness=[40.0], damping=[3.0], rest=[0.1]), 1e-4
        q, u, _ = system.assemble([1.2, -1.0, 1.8], [2, 0, 0], kept=["crank"])
        turn = math.remainder(q[2] - q[0] - q[1] - 0.1, math.tau)
        self.assertAlmostEqual(system.energy(q, u).elastic, 20 * turn**2, 9)
        motion = system.integrate(q, u, 2 * h, output_step=h, tolerance=1e-12)
        energies = [sum(system.energy(*at)) for at in zip(motion.q, motion.u)]
        rate = motion.u[1] @ [-1, -1, 1]
        self.assertGreater(abs(rate), 0.5)
        self.assertAlmostEqual((energies[2] - energies[0]) / (2 * h) / (-3 * rate**2), 1, 5)

    def test_hinges_are_turned_and_momenta_those_of_the_masses(self):
        half = math.radians(35)
        system = ld.Multibody([pendulum(at=(0.3, 0.1, -0.2),
                                        attitude=(math.cos(half), 0, 0, math.sin(half)))])
        place = system.locate("bob", [0.2], [1.5], (0, -0.7, 0))
        angle = 2 * half + 0.2
        np.testing.assert_allclose(place.position, [0.3 + 0.7 * math.sin(angle),
                                                    0.1 - 0.7 * math.cos(angle), -0.2], atol=1e-15)
        linear, angular = system.momentum([0.2], [1.5])
        np.testing.assert_allclose(linear, 2 * place.velocity, atol=1e-14)
        np.testing.assert_allclose(angular, np.cross(place.position, linear), atol=1e-14)
        np.testing.assert_allclose(place.rate, [0, 0, 1.5], atol=1e-14)

    def test_a_drive_acts_and_its_errors_come_out(self):
        system = ld.Multibody([pendulum()], gravity=(0, 0, 0))
        motion = system.integrate([0], [0], 2, drive=lambda t, q, u: [0.98 * t])
        np.testing.assert_allclose([motion.q[-1, 0], motion.u[-1, 0]], [8 / 6, 2], rtol=1e-7)
        with self.assertRaises(ZeroDivisionError):
            system.integrate([0], [0], 2, drive=lambda t, q, u: [1 / 0])
        with self.assertRaisesRegex(ValueError, "tau: expected 1 numbers, found 2"):
            system.integrate([0], [0], 2, drive=lambda t, q, u: [1, 2])
        with self.assertRaisesRegex(ValueError, "read-only"):
            system.integrate([0], [0], 2, drive=lambda t, q, u: q.fill(1))

    def test_wrong_systems_are_refused(self):
        with self.assertRaisesRegex(ld.InputError, "bob"):
            ld.Multibody([pendulum(parent="nobody")])
        with self.assertRaisesRegex(ld.UnknownName, 'no hinge "hinge"; there are weld'):
            ld.Multibody([ld.Body("a", hinge="hinge")])
        with self.assertRaisesRegex(ValueError, "at: expected up to 3 numbers"):
            ld.Multibody([pendulum(at=(1, 2, 3, 4))])
        with self.assertRaisesRegex(ld.InputError, "pin"):
            four_bar().assemble([0, 0, 0], [0, 0, 0], kept=["crank", "coupler", "rocker"])
        system = double()
        with self.assertRaisesRegex(ValueError, "u: expected 2 numbers, found 3"):
            system.energy([0, 0], [0, 0, 0])
        with self.assertRaisesRegex(ld.UnknownName, 'no body "uper"'):
            system.locate("uper", [0, 0], [0, 0])
        with self.assertRaises(ld.LaunchdynError):
            system.vibration([0.5, 0])
        system.close()
        with self.assertRaisesRegex(ValueError, "closed"):
            system.energy([0, 0], [0, 0])


if __name__ == "__main__":
    unittest.main()
