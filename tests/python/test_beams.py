"""Multibody systems: beams, prescribed hinges and reactions against closed forms."""

import dataclasses
import math
import unittest

import launchdyn as ld
import numpy as np
from support import Case

G = 9.81
X, Y, Z = np.eye(3)
STILL = (0, 0, 0)
#: Unequal planes: E I is 60 N m2 about y, 35 about z.
FLAT = ld.Section(1.5, (60, 35), 4e5, 12, 2e-3)
L = 1.3


def cantilever(beam, *more, gravity=STILL, **of_body):
    return ld.Multibody([ld.Body("beam", beam=beam, **of_body), *more], gravity=gravity)


def frame(station=L, **more):
    """A welded frame at a station of the beam, or a body there."""
    return ld.Body("end", "beam", at=(station, 0, 0), **more)


def at_rest(system, wrench=None):
    """The equilibrium of a system whose forces are linear in its coordinates."""
    still, n = np.zeros(len(system.reference)), len(system.reference)
    def forces(q):
        return system.forces(q, still, still, wrench)
    step = 1e-3
    slope = np.array([forces(step * row) - forces(-step * row) for row in np.eye(n)]).T / (2 * step)
    return np.linalg.solve(slope, -forces(still))


def root(function, low, high):
    """A zero of a function between two numbers, by halves."""
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if function(low) * function(middle) > 0 else (low, middle)
    return low


def frequencies(system, **more):
    return np.array([mode.frequency for mode in system.vibration(system.reference, **more)])


class Near(Case):
    def near(self, what, found, expected, bound):
        super().near(what, found, expected, bound, relative=True)


class TestBeams(Near):
    def test_frequencies_of_a_cantilever(self):
        def bending(of):
            return [root(lambda x: math.cos(x) * math.cosh(x) + 1, low, low + 1)**2 *
                    math.sqrt(of / 1.5) / L**2 / math.tau for low in (1.5, 4.2)]
        quarter = math.tau / 4 / L / math.tau  # of waves along the beam, with a free end
        expected = sorted([*bending(60), *bending(35), quarter * math.sqrt(12 / 2e-3),
                           quarter * math.sqrt(4e5 / 1.5)])
        found = frequencies(cantilever(ld.Beam(L, FLAT, bending=6, torsion=2, axial=2)))
        nearest = [found[np.argmin(abs(found - value))] for value in expected]
        self.assertEqual(len(found), 16)
        self.near("cantilever: frequencies", nearest, expected, 2e-4)
        clamped = frequencies(cantilever(ld.Beam(L, FLAT, bending=2, span="clamped")))
        self.near("cantilever by its own shapes: frequencies", clamped[:4],
                  sorted([*bending(60), *bending(35)]), 4e-7)

    def test_shapes_of_all_spans_serve_a_pinned_beam(self):
        expected = root(lambda x: math.tan(x) - math.tanh(x), 3.7, 4.2)**2 * \
            math.sqrt(35 / 1.5) / L**2 / math.tau
        for span, modes, bound in (("clamped", 6, 2e-6), ("tip-loaded", 6, 2e-5),
                                   ("free-free", 6, 1.3e-3), ("free-free", 12, 2e-4)):
            found = frequencies(cantilever(ld.Beam(L, FLAT, bending=modes, span=span),
                                           hinge="revolute", axis=Z))
            self.near(f"pinned beam, {modes} shapes, {span}: frequency",
                      found[np.argmin(abs(found - expected))], expected, bound)

    def test_a_mass_at_the_tip(self):
        mass = 0.9
        ratio = mass / (1.5 * L)
        def characteristic(x):
            return 1 + math.cos(x) * math.cosh(x) + ratio * x * (
                math.cos(x) * math.sinh(x) - math.sin(x) * math.cosh(x))
        expected = [root(characteristic, 0.8, 1.6)**2 * math.sqrt(of / 1.5) / L**2 / math.tau
                    for of in (35, 60)]
        found = frequencies(cantilever(ld.Beam(L, FLAT), frame(mass=mass)))
        self.near("mass at the tip: frequencies", found[:2], expected, 2e-9)

    def test_sag_and_reactions(self):
        system = cantilever(ld.Beam(L, FLAT, geometric_stiffness=False), frame(),
                            gravity=(0, -G, 0))
        q = at_rest(system)
        tip = system.locate("beam", q, 0 * q, (L, 0, 0))
        self.near("sag under the own weight", tip.position[1],
                  -1.5 * G * L**4 / (8 * 35), 1e-13)
        weight = 1.5 * L * G
        found = system.reactions(q, 0 * q)
        self.near("weight and moment at the clamp", found.hinges[0, [1, 5]],
                  [weight, weight * L / 2], 1e-13)
        self.assertLess(abs(found.rates).max(), 1e-9)

    def test_steps_shear_and_loads_at_stations(self):
        force, reach = 4.0, 0.9
        wrench = [np.zeros(6), [0, 0, force, 0, 0, 0]]
        def deflection(beam):
            system = cantilever(dataclasses.replace(beam, bending=4, geometric_stiffness=False),
                                frame())
            q = at_rest(system, wrench)
            return system.locate("end", q, 0 * q).position[2]
        outer = dataclasses.replace(FLAT, bending_stiffness=(20, 8), start=0.4)
        stepped = ld.Beam(L, [FLAT, outer])
        self.near("stepped beam: deflection", deflection(stepped),
                  force * ((L**3 - reach**3) / (3 * 60) + reach**3 / (3 * 20)), 1e-13)
        round_one = dataclasses.replace(FLAT, bending_stiffness=60)
        area = 12 * 1.5 / 2e-3  # G A of round sections
        sheared = ld.Beam(L, round_one, shear_coefficient=0.6)
        self.near("with shear: deflection", deflection(sheared),
                  force * (L**3 / (3 * 60) + L / (0.6 * area)), 1e-13)

    def test_a_mast_buckles_under_its_weight(self):
        critical = 7.837347 * 35 / (1.5 * L**3)  # Greenhill's load, of the weaker plane
        def first(share, **more):
            mast = cantilever(ld.Beam(L, FLAT, bending=6, **more),
                              gravity=(-share * critical, 0, 0))
            return mast.vibration(mast.reference)[0]
        stands, falls = first(0.999), first(1.001)
        self.assertGreater(stands.frequency, 0)
        self.assertLess(abs(stands.rate), 1e-6)
        self.assertEqual(falls.frequency, 0)
        self.assertGreater(abs(falls.rate), 0.1)
        without = first(0.999, geometric_stiffness=False)
        self.near("without geometric stiffness the weight does not matter", without.frequency,
                  first(0).frequency, 1e-12)

    def test_damping_is_that_of_the_shapes(self):
        found = cantilever(ld.Beam(L, FLAT, damping=0.03, span="clamped"))
        for mode in found.vibration(found.reference):
            self.assertAlmostEqual(mode.damping, 0.03, 9)

    def test_tubes_have_the_integrals_of_their_rings(self):
        tube = ld.Section.tube(0.05, 0.041, density=2700, youngs_modulus=70e9, shear_modulus=26e9,
                               start=0.7)
        edges = np.linspace(0.041, 0.05, 20001)
        r, dr = (edges[1:] + edges[:-1]) / 2, edges[1] - edges[0]
        def rings(power):
            return float(math.tau * np.sum(r**power) * dr)
        self.near("tube: masses and stiffnesses",
                  [tube.mass_per_length, tube.axial_stiffness, tube.polar_inertia,
                   tube.torsion_stiffness, tube.bending_stiffness],
                  [2700 * rings(1), 70e9 * rings(1), 2700 * rings(3), 26e9 * rings(3),
                   70e9 * rings(3) / 2], 1e-10)
        self.assertEqual(tube.start, 0.7)

    def test_coordinates_of_modes_follow_those_of_the_hinge(self):
        system = ld.Multibody([
            ld.Body("base", hinge="free", mass=3, inertia=(1, 2, 2.5)),
            ld.Body("arm", "base", "revolute", axis=Z, beam=ld.Beam(L, FLAT, bending=3, axial=1)),
            ld.Body("bob", "arm", "spherical", at=(L, 0, 0), mass=1, inertia=(1, 1, 1))])
        self.assertEqual([system.coordinates(body) for body in system.bodies],
                         [slice(0, 7), slice(7, 16), slice(16, 20)])
        self.assertEqual([system.speeds(body) for body in system.bodies],
                         [slice(0, 6), slice(6, 15), slice(15, 18)])
        self.assertEqual(system.reference[16], 1)

    def test_wrong_beams_are_refused(self):
        late = dataclasses.replace(FLAT, start=0.1)
        light = dataclasses.replace(FLAT, polar_inertia=0)
        for beam, said in (
                (ld.Beam(0, FLAT), "'beam': a beam needs a length"),
                (ld.Beam(L, ()), "at least one section"),
                (ld.Beam(L, FLAT, bending=99), "at most 24 bending modes"),
                (ld.Beam(L, FLAT, damping=-0.1), "damping ratio -0.1, expected 0 to 1"),
                (ld.Beam(L, late), "section 1 of the beam begins at 0.1 m, expected it at 0 m"),
                (ld.Beam(L, [FLAT, late, FLAT]), "section 3 of the beam begins at 0 m, expected it "
                                                 "beyond 0.1 m"),
                (ld.Beam(L, light), "section 1 of the beam needs mass")):
            with self.assertRaisesRegex(ld.InputError, said):
                cantilever(beam)
        with self.assertRaisesRegex(ld.UnknownName, 'no span "free"; there are clamped, free-free'):
            cantilever(ld.Beam(L, FLAT, span="free"))
        with self.assertRaisesRegex(ValueError, "bending_stiffness: expected a number, or one"):
            cantilever(ld.Beam(L, dataclasses.replace(FLAT, bending_stiffness=(1, 2, 3))))


class TestGivenMotion(Near):
    def body(self, **more):
        """2 kg, 0.7 m below its hinge, not a point."""
        return ld.Body("bob", hinge="revolute", axis=Z, mass=2, center=(0, -0.7, 0),
                       inertia=(0.05, 0.02, 0.06), **more)

    def test_torque_of_a_prescribed_hinge(self):
        system, about = ld.Multibody([self.body(prescribed=True)]), 0.06 + 2 * 0.49
        expected = about * 1.7 + 2 * G * 0.7 * math.sin(0.6)
        self.near("torque of a prescribed hinge", [
            system.forces([0.6], [2.5], [1.7])[0],
            system.reactions([0.6], [2.5], tau=[1.7]).hinges[0, 5]], [expected, expected], 1e-15)
        self.assertEqual(system.accelerations([0.6], [2.5], tau=[1.7])[0], 1.7)

    def test_reactions_of_a_pendulum(self):
        system, q, w = ld.Multibody([self.body()]), 0.8, 2.2
        found = system.reactions([q], [w])
        along, across = np.array([-math.sin(q), math.cos(q), 0]), \
            np.array([math.cos(q), math.sin(q), 0])
        about = 0.06 + 2 * 0.49
        self.near("reaction of a pendulum", found.hinges[0] @ np.array(
            [[*along, *STILL], [*across, *STILL], *np.eye(6)[2:]]).T,
            [2 * (G * math.cos(q) + w**2 * 0.7), 2 * G * math.sin(q) * 0.06 / about, 0, 0, 0, 0],
            1e-14)
        self.near("its acceleration", found.rates, -2 * G * 0.7 * math.sin(q) / about, 1e-15)

    def test_bearings_of_an_unbalanced_rotor(self):
        products, w = (0.01, -0.004), 30.0  # J_xy, J_xz
        rotor = ld.Body("rotor", hinge="revolute", axis=X, mass=4, center=(0.2, 0.003, 0),
                        inertia=(0.1, 0.2, 0.25, *products, 0), prescribed=True)
        found = ld.Multibody([rotor], gravity=STILL).reactions([0], [w], tau=[0]).hinges[0]
        force = np.array([0, -4 * w**2 * 0.003, 0])
        moment = np.cross([0.2, 0.003, 0], force) + w**2 * np.array([0, -products[1], products[0]])
        self.near("bearing of an unbalanced rotor", found, [*force, *moment], 1e-15)

    def test_wrenches_and_what_hangs_below_are_carried(self):
        system = ld.Multibody([ld.Body("upper", mass=3), ld.Body("lower", "upper", at=(0.5, 0, 0),
                                                                 mass=1.2, center=(0, 0.1, 0))])
        found = system.reactions([], [], wrench=[[0, 0, 7, 0, 0, 0], [0, 2, 0, 0, 1, 0]])
        self.near("forces and moments through two welds", found.hinges, [
            [0, 4.2 * G - 2, -7, 0, -1, 0.5 * (1.2 * G - 2)], [0, 1.2 * G - 2, 0, 0, -1, 0]], 1e-15)

    def test_pins_of_a_loop_carry_their_share(self):
        """A bar of 2 m on two hanging links, its centre a quarter from the first."""
        link = {"hinge": "revolute", "axis": Z, "mass": 0.1, "center": (0, -0.5, 0)}
        system = ld.Multibody(
            [ld.Body("first", **link), ld.Body("second", at=(2, 0, 0), **link),
             ld.Body("bar", "first", "revolute", at=(0, -1, 0), axis=Z, mass=8, center=(0.5, 0, 0),
                     inertia=(0, 1, 1))],
            [ld.LoopJoint("pin", "bar", "second", "revolute", (2, 0, 0), (0, -1, 0), axis=Z)])
        q, u, _ = system.assemble([0, 0, 0], [0, 0, 0])
        found = system.reactions(q, u)
        self.near("pin of a loop", found.loops, [[0, -2 * G, 0, 0, 0, 0]], 1e-15)
        self.near("hinges beside it", found.hinges[:, 1], [6.1 * G, 2.1 * G, 6 * G], 1e-15)

    def test_a_lift_changes_a_pendulums_period(self):
        """A pendulum in a lift that speeds up with 3 m/s2 swings as under 12.81 m/s2."""
        lift = ld.Body("lift", hinge="prismatic", axis=Y, prescribed=True)
        system = ld.Multibody([lift, ld.Body("bob", "lift", "revolute", axis=Z, mass=2,
                                             center=(0, -0.7, 0))])
        amplitude, rise = 1.4, 3.0
        a, b = 1.0, math.cos(amplitude / 2)
        while abs(a - b) > 1e-15:
            a, b = (a + b) / 2, math.sqrt(a * b)
        half = math.pi * math.sqrt(0.7 / (G + rise)) / a
        def motion(t):
            return {"lift": ([0.2 + rise * t**2 / 2], [rise * t], [rise])}
        run = system.integrate([0, amplitude], [0, 0], half, tolerance=1e-11, motion=motion)
        np.testing.assert_allclose(run.q[0], [0.2, amplitude], rtol=1e-15)
        self.near("pendulum in a lift after half a period", [*run.q[-1], *run.u[-1]],
                  [0.2 + rise * half**2 / 2, -amplitude, rise * half, 0], 5e-11)

    def test_drive_and_motion_act_together(self):
        """A drive's numbers for what is prescribed are not used."""
        system = ld.Multibody([
            ld.Body("cart", hinge="prismatic", axis=X, mass=5, prescribed=True),
            ld.Body("slide", "cart", "prismatic", axis=X, mass=2)], gravity=STILL)
        run = system.integrate([0, 0], [0, 0], 2, drive=lambda t, q, u: [1e3, 3 * t],
                               motion=lambda t: {"cart": ([t**3 / 6], [t**2 / 2], [t])})
        self.near("cart and slide: place and speed", [*run.q[-1], *run.u[-1]],
                  [8 / 6, 8 / 12, 2, 1], 1e-14)
        self.assertAlmostEqual(system.integrate([0, 0], [1, 0], 2).q[-1, 0], 2, 12)

    def test_a_spherical_hinge_is_led(self):
        """Turned about a skew axis at a constant rate, it throws off what slides across."""
        axis, w = np.array([2, -1, 2]) / 3, 1.3
        system = ld.Multibody([ld.Body("top", hinge="spherical", prescribed=True),
                               ld.Body("slide", "top", "prismatic", axis=(1, 2, 0), mass=2)],
                              gravity=STILL)
        def motion(t):
            return {"top": ([math.cos(w * t / 2), *(math.sin(w * t / 2) * axis)], w * axis, STILL)}
        run = system.integrate([1, 0, 0, 0, 0.3], [*(w * axis), 0], 3, tolerance=1e-10,
                               motion=motion)
        self.near("led spherical hinge and its slide", run.q[-1],
                  [*motion(3)["top"][0], 0.3 * math.cosh(3 * w)], 5e-10)

    def test_a_hinge_is_locked_and_released(self):
        system = ld.Multibody([self.body()])
        system.prescribe("bob")
        self.assertEqual(system.accelerations([0.6], [0])[0], 0)
        run = system.integrate([0.6], [0], 1, motion=lambda t: {"bob": ([0.6 + t], [1], [0])})
        np.testing.assert_allclose(run.q[-1], [1.6], rtol=1e-15)
        system.prescribe("bob", False)
        self.assertLess(system.accelerations([0.6], [0])[0], -1)
        with self.assertRaisesRegex(ValueError, "bob: its hinge is not prescribed"):
            system.integrate([0.6], [0], 1, motion=lambda t: {"bob": ([0], [0], [0])})

    def test_errors_of_a_motion_come_out(self):
        system = ld.Multibody([self.body(prescribed=True)])
        for wrong, error, said in (
                (lambda t: {"bob": ([0, 1], [0], [0])}, ValueError, "bob: coordinates: expected 1"),
                (lambda t: {"bob": ([0], [0], [0, 0])}, ValueError, "bob: rates: expected 1"),
                (lambda t: {"bobb": ([0], [0], [0])}, ld.UnknownName, 'no body "bobb"'),
                (lambda t: 1 / 0, ZeroDivisionError, "")):
            with self.assertRaisesRegex(error, said):
                system.integrate([0], [0], 1, motion=wrong)


if __name__ == "__main__":
    unittest.main()
