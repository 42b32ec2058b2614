"""Scenarios: read, set and described; what is wrong with its place."""

import copy
import math
import pickle
import unittest
import zipfile

import launchdyn as ld
import numpy as np
from launchdyn._values import key_of, value_text
from support import EXAMPLES, FIXED, Case, command

SMALL = {
    "title": "A launch: of one's own",
    "base": {"kind": "fixed", "elevation": (20, "deg")},
    "tubes": {"length": 3, "sections": [{"from": 0, "inner_radius": 0.0825,
                                         "outer_radius": "85 mm"}],
              "material": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850},
              "slot": "none",
              "supports": [{"at": "0.4 m", "stiffness": [2e7, 2e7, 2e7],
                            "rotational_stiffness": [2e5, 2e5, 2e5]},
                           {"at": 1.8, "stiffness": ((2e4, 2e4, 2e4), "kN/m")}]},
    "rocket": {"mass": 60, "center": (1.1, 0, 0), "inertia": np.array([0.22, 24, 24]),
               "adaptors": [{"name": "rear", "at": 0.0, "clearance": "0.3 mm"},
                            {"name": "front", "at": 1.9, "clearance": 4e-4}],
               "contact": {"law": "hunt-crossley", "stiffness": 5e7, "exponent": 1,
                           "reference_penetration": 1e-3, "restitution": 0.5,
                           "reference_speed": 0.5, "friction": 0.12, "friction_speed": "10 mm/s"},
               "lock": {"release_force": 5e3},
               "motor": {"thrust": [[0, 0], ["10 ms", 15000.0], (2.5, 15e3), [2.55, 0]]}},
    "firing": [{"tube": 1, "at": 0}],
    "run": {"end": "tip"},
}


class TestScenario(Case):
    def test_a_dict_is_as_a_file(self):
        read = ld.Scenario.from_dict(SMALL)
        path = self.folder / "small.yaml"
        path.write_text("""launchdyn: 1
title: "A launch: of one's own"
base: {kind: fixed, elevation: 20 deg}
tubes:
  length: 3 m
  sections: [{from: 0 m, inner_radius: 82.5 mm, outer_radius: 85 mm}]
  material: {youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7850 kg/m3}
  slot: none
  supports:
    - {at: 0.4 m, stiffness: 2e7 2e7 2e7 N/m, rotational_stiffness: 2e5 2e5 2e5 N.m/rad}
    - {at: 1.8 m, stiffness: 2e7 2e7 2e7 N/m}
rocket:
  mass: 60 kg
  center: 1.1 0 0 m
  inertia: 0.22 24 24 kg.m2
  adaptors: [{name: rear, at: 0 m, clearance: 0.3 mm}, {name: front, at: 1.9 m, clearance: 0.4 mm}]
  contact: {law: hunt-crossley, stiffness: 5e7 N/m, exponent: 1, reference_penetration: 1 mm,
            restitution: 0.5, reference_speed: 0.5 m/s, friction: 0.12, friction_speed: 10 mm/s}
  lock: {release_force: 5 kN}
  motor: {thrust: [[0 s, 0 N], [10 ms, 15 kN], [2.5 s, 15 kN], [2.55 s, 0 N]]}
firing: [{tube: 1, at: 0 s}]
run: {end: tip}
""")
        self.assertEqual(read.to_yaml(), ld.Scenario.read(path).to_yaml())
        self.assertEqual(read.title, "A launch: of one's own")

    def test_what_is_printed_is_what_the_command_prints(self):
        read = ld.Scenario.read(FIXED, {"rocket.mass": 61})
        printed = command("check", FIXED, "--set", "rocket.mass=61 kg")
        self.assertIn(read.to_yaml(), printed)
        self.assertEqual(ld.Scenario.from_text(read.to_yaml()).to_yaml(), read.to_yaml())

    def test_values_are_told_in_si(self):
        read = ld.Scenario.read(FIXED)
        self.assertEqual(read["rocket.mass"], 60.0)
        self.assertEqual(read["base.elevation"], math.radians(19.8))
        self.assertEqual(read["base.kind"], "fixed")
        self.assertEqual(read["title"], "Reference launcher on a fixed base")
        self.assertEqual(read["rocket.adaptors.front.clearance"], 0.4e-3)
        np.testing.assert_array_equal(read["rocket.inertia"], [0.22, 24, 24])
        self.assertEqual(read["rocket.inertia.y"], 24)
        np.testing.assert_array_equal(read["rocket.eccentricity"], [0, 0])
        read["rocket.motor.thrust"][1] = 7  # a copy
        np.testing.assert_allclose(read["rocket.motor.thrust"],
                                   [[0, 0], [0.01, 15e3], [2.5, 15e3], [2.55, 0]], rtol=0)
        self.assertEqual(read.text("rocket.mass"), "60 kg")
        self.assertEqual(read.key("tubes.supports.2.at").unit, "m")
        self.assertTrue(read.has_launcher)
        self.assertFalse(read.has_vehicle)

    def test_what_is_told_can_be_set_again(self):
        read = ld.Scenario.read(FIXED)
        before = read.to_yaml()
        for key in ld.keys():
            path = key.path.replace("adaptors.N", "adaptors.rear").replace(".N", ".1")
            try:
                value = read[path]
            except ld.InputError:
                continue  # of another kind of base, guide, ...
            if isinstance(value, float) and not math.isfinite(value) or len(str(value)) == 0 or \
                    (isinstance(value, np.ndarray) and (not value.size or np.isnan(value).any())):
                continue
            with self.subTest(path):
                try:
                    told = read.derive({path: value})
                except ld.InputError as error:  # goes not with the others, as they stand there
                    self.assertNotIn("unit", str(error))
                    continue
                again = told[path]
                self.assertTrue(np.array_equal(again, value), (value, again))
        self.assertEqual(read.to_yaml(), before)

    def test_numbers_units_and_words_are_set(self):
        read = ld.Scenario.read(FIXED)
        read["rocket.mass"] *= 1.5
        self.assertEqual(read["rocket.mass"], 90)
        read["rocket.mass"] = (61500, "g")
        self.assertEqual(read["rocket.mass"], 61.5)
        read["rocket.center"] = [1.2, 0, 0.001]
        np.testing.assert_array_equal(read["rocket.center"], [1.2, 0, 0.001])
        read["rocket.eccentricity"] = (1e-3, 2e-3)
        self.assertEqual(read["rocket.eccentricity.z"], 2e-3)
        np.testing.assert_array_equal(read["rocket.eccentricity"], [1e-3, 2e-3])
        read["rocket.center.x"] = 1.1
        self.assertEqual(read.text("rocket.center"), "1.1 0 0.001 m")
        read["tubes.slot"] = "none"
        read.set({"base.kind": "prescribed", "base.velocity": (3, 0, 0)})
        self.assertEqual(read["base.kind"], "prescribed")
        read["tubes.modes.bending"] = np.int64(4)
        self.assertEqual(read["tubes.modes.bending"], 4)
        read["rocket.motor.thrust"] = np.array([[0, 1e4], [3, 1e4]])
        self.assertEqual(read["run.stuck_time"], 4)

    def test_attitudes_begin_with_their_scalar_part(self):
        read = ld.Scenario.read(EXAMPLES / "flight.yaml", {
            "flight.attitude": None, "flight.quaternion": (0.8, 0, 0.6, 0)})
        np.testing.assert_array_equal(read["flight.quaternion"], [0.8, 0, 0.6, 0])
        self.assertEqual(read["flight.quaternion.w"], 0.8)

    def test_results_keep_the_scenario_they_are_of(self):
        read = ld.Scenario.read(FIXED)
        result = read.run()
        other = read.derive({"rocket.mass": 70})
        before = result.summary["rocket.1.exit_speed"]
        read["rocket.mass"] = 50
        self.assertEqual(result.summary["rocket.1.exit_speed"], before)
        self.assertEqual((other["rocket.mass"], read["rocket.mass"]), (70, 50))
        speeds = [s.run().summary["rocket.1.exit_speed"] for s in (other, read)]
        self.assertLess(speeds[0], before)
        self.assertGreater(speeds[1], before)

    def test_sweeps(self):
        read = ld.Scenario.read(FIXED, {"sweep": {"rocket.mass": [60, 61, "62 kg"]}})
        self.assertEqual(read.points, 3)
        self.assertEqual([read.point(i)["rocket.mass"] for i in (1, 2, 3)], [60, 61, 62])
        self.assertEqual(read.point_name(3), "rocket.mass 62 kg")
        with self.assertRaises(ld.InputError):
            read.point(4)

    def test_closed_is_closed(self):
        with ld.Scenario.read(FIXED) as read:
            result = read.run()
        with self.assertRaisesRegex(ValueError, "closed"):
            read["rocket.mass"]
        self.assertGreater(result.summary["rocket.1.exit_speed"], 30)
        self.assertIn("exit speed", str(result))

    def test_keys(self):
        found = {key.path: key for key in ld.keys()}
        mass = found["rocket.mass"]
        self.assertEqual((mass.unit, mass.low, mass.required), ("kg", 0, True))
        self.assertEqual(key_of("rocket.adaptors.rear.clearance").path,
                         "rocket.adaptors.N.clearance")
        self.assertEqual(key_of("rocket.motor.misalignment.z").unit, "rad")
        self.assertIsNone(key_of("rocket.mas"))

    def test_export(self):
        file = self.folder / "launch.fmu"
        for words, said in (({}, 'fmiVersion="3.0"'), ({"version": 2}, 'fmiVersion="2.0"')):
            ld.Scenario.read(FIXED).export_fmu(file, **words)
            with zipfile.ZipFile(file) as package:
                self.assertIn(said, package.read("modelDescription.xml").decode())
        ld.Scenario.read(FIXED).export_fmu(file, outputs="tip.y,*.exit_speed", parameters="")
        with zipfile.ZipFile(file) as package:
            text = package.read("modelDescription.xml").decode()
        self.assertEqual((text.count('causality="output"'), text.count('name="scenario.')), (2, 0))
        with self.assertRaisesRegex(ld.InputError, 'no output "tip.q"'):
            ld.Scenario.read(FIXED).export_fmu(file, outputs="tip.q")
        with self.assertRaisesRegex(ValueError, "one of all, vehicle, launcher"):
            ld.Scenario.read(FIXED).export_fmu(file, part="lunch")
        with self.assertRaises(ld.InputError):
            ld.Scenario.read(FIXED).export_fmu(file, version=4)


class TestErrors(Case):
    def test_all_that_is_wrong_with_places(self):
        path = self.folder / "wrong.yaml"
        path.write_text(f"include: {FIXED}\n\nrocket:\n  mas: 61 kg\n  center: 1 m\n")
        with self.assertRaises(ld.InputError) as caught:
            ld.Scenario.read(path)
        with self.assertRaises(ld.InputError) as same:
            ld.Scenario.from_text(path.read_text().replace(str(FIXED), "fixed.yaml"),
                                  name="words", folder=EXAMPLES)
        self.assertEqual([(m.file, m.line, m.key) for m in same.exception.messages],
                         [("words", m.line, m.key) for m in caught.exception.messages])
        error = caught.exception
        self.assertEqual(error.code, ld.Status.INPUT)
        self.assertEqual((error.file, error.line, error.column), (str(path), 4, 3))
        self.assertEqual((error.key, error.suggestion), ("rocket.mas", "mass"))
        self.assertEqual(error.messages[1].key, "rocket.center")
        self.assertIsNone(error.messages[1].suggestion)
        self.assertEqual(error.messages[1].source, "  center: 1 m")
        self.assertEqual(str(error).splitlines()[0],
                         f'{path}:4:3: rocket.mas: unknown key, did you mean "mass"?')

    def test_a_value_that_is_set(self):
        read = ld.Scenario.read(FIXED)
        with self.assertRaises(ld.InputError) as caught:
            read["rocket.mass"] = "61 m"
        self.assertEqual((caught.exception.file, caught.exception.key), ("--set", "rocket.mass"))
        self.assertTrue(str(caught.exception).startswith('rocket.mass: found "61 m", a unit of'))
        self.assertEqual(read["rocket.mass"], 60)
        with self.assertRaises(ld.InputError) as caught:
            read.set({"rocket.mass": 61, "base.elevation": "1 m"})
        self.assertEqual((caught.exception.line, caught.exception.key), (2, "base.elevation"))
        with self.assertRaises(ld.InputError) as caught:
            read["tubes.modes.span"] = "suported"
        self.assertEqual(caught.exception.suggestion, "supported")

    def test_what_is_no_text(self):
        read = ld.Scenario.read(FIXED)
        simulation = read.simulation()
        with simulation.begin() as run:
            for wrong in (3, None, b"t"):
                for get in (run.__getitem__, read.__getitem__, read.text):
                    with self.assertRaisesRegex(TypeError, "found (int|NoneType|bytes)"):
                        get(wrong)
            with self.assertRaises(ValueError):
                run["t\0x"]
        for saved in (None, "text", 3):
            with self.assertRaisesRegex(TypeError, "expected the bytes of Run.save"):
                simulation.load(saved)
        for act in (lambda: read["rocket.mass\0x"], lambda: read.set({"title": "a\0b"}),
                    lambda: read.set(["title=a\0b"]), lambda: ld.Scenario.from_text("title: a\0"),
                    lambda: ld.Scenario.from_dict({"title": "a\0b"}),
                    lambda: ld.Scenario.read(f"{FIXED}\0.yaml"), lambda: read.run("a\0b")):
            with self.assertRaisesRegex(ValueError, "NUL character"):
                act()

    def test_a_key_that_is_not_there(self):
        read = ld.Scenario.read(FIXED)
        for get in (read.__getitem__, read.text):
            with self.assertRaises(KeyError) as caught:
                get("rocket.mas")
            self.assertIsInstance(caught.exception, ld.UnknownName)
            self.assertEqual(caught.exception.suggestion, "mass")
            self.assertIn('no key "mas" in rocket', str(caught.exception))
        with self.assertRaises(ld.UnknownName):
            read["base.wheels.1.mount"]

    def test_a_run_that_cannot_start_says_where(self):
        path = self.folder / "spread.yaml"
        path.write_text(f"include: {EXAMPLES / 'reference.yaml'}\n"
                        "platform:\n  elevation:\n    stabiliser: {kp: 1 N.m/rad}\n")
        read = ld.Scenario.read(path)
        with self.assertRaises(ld.InputError) as caught:
            read.run()
        self.assertEqual(caught.exception.key, "platform.elevation.stabiliser")
        self.assertEqual(caught.exception.file, str(EXAMPLES / "reference.yaml"))
        self.assertGreater(caught.exception.line, 0)
        with self.assertRaises(ld.InputError):
            read.begin()

    def test_files_that_are_not_there(self):
        with self.assertRaises(ld.LaunchdynError) as caught:
            ld.Scenario.read(self.folder / "nowhere.yaml")
        self.assertIn("nowhere.yaml", str(caught.exception))
        with self.assertRaisesRegex(ld.FileError, "cannot be read"):
            ld.Scenario.read("/proc/self/mem")
        with self.assertRaises(ld.FileError):
            ld.Scenario.read(FIXED).run(out="/proc/nowhere")
        with self.assertRaisesRegex(ValueError, "csv requires a folder"):
            ld.Scenario.read(FIXED).run(csv=True)

    def test_values_of_no_kind(self):
        read = ld.Scenario.read(FIXED)
        with self.assertRaisesRegex(ValueError, "no number nan"):
            read["rocket.mass"] = math.nan
        with self.assertRaisesRegex(TypeError, "object is not a value"):
            read["rocket.mass"] = object()
        with self.assertRaises(TypeError):
            ld.Scenario.read(FIXED, "rocket.mass=61 kg")
        with self.assertRaisesRegex(TypeError, "create a scenario by Scenario.read"):
            ld.Scenario(FIXED)
        self.assertEqual(value_text("title", {"a": "- b"}), '{a: "- b"}')
        self.assertEqual(value_text("base.road.flat", True), "true")

    def test_notes(self):
        note, = ld.Scenario.read(FIXED, {"rocket.adaptors.front.at": "100 m"}).notes()
        self.assertEqual((note.key, note.suggestion), ("rocket.adaptors.front.at", "100 mm"))
        self.assertEqual(ld.Scenario.read(FIXED).notes(), [])

    def test_errors_travel(self):
        with self.assertRaises(ld.InputError) as caught:
            ld.Scenario.read(FIXED, {"rocket.mas": 1})
        for other in (pickle.loads(pickle.dumps(caught.exception)), copy.copy(caught.exception)):
            self.assertEqual(other.messages, caught.exception.messages)
            self.assertEqual((str(other), other.code), (str(caught.exception), ld.Status.INPUT))


if __name__ == "__main__":
    unittest.main()
