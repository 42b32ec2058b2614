"""Expressions of measures: against Python's grammar, against numpy over a history, in studies."""

import math
import random
import re
import unittest

import launchdyn as ld
import numpy as np
from support import EXAMPLES, FIXED, Case, command

RESULTS = {"exit_speed": "m/s", "yaw_rate": "rad/s", "pitch": "rad", "tip.y": "m",
           "max_contact_force.rear": "N", "t_rear": "s"}
FUNCTIONS = {"abs": abs, "sqrt": math.sqrt, "hypot": math.hypot, "min": min, "max": max,
             "sin": math.sin, "cos": math.cos, "atan": math.atan}


class Texts:
    """Random expressions without units, with few parentheses: precedence is what they try."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def operand(self, depth):
        kind = self.random.randrange(8 if depth < 3 else 3)
        if kind < 2:
            name = self.random.choice(list(RESULTS))
            return f"({name} / 1 {RESULTS[name]})"
        if kind == 2:
            return f"{self.random.uniform(0.1, 3):.3g}"
        if kind == 3:
            return f"({self.sum(depth + 1)})"
        if kind == 4:
            sign = self.random.choice(["<", ">", "<=", ">="])
            return f"({self.sum(depth + 1)} {sign} {self.sum(depth + 1)})"
        name = self.random.choice(["min", "max", "hypot"] if kind == 5 else
                                  ["sin", "cos", "atan", "abs", "sqrt"])
        if name == "sqrt":
            return f"sqrt(abs({self.sum(depth + 1)}))"
        if name in ("sin", "cos"):
            return f"{name}(({self.sum(depth + 1)}) * 1 rad)"
        if name == "atan":
            return f"(atan({self.sum(depth + 1)}) / 1 rad)"
        more = f", {self.sum(depth + 1)}" if kind == 5 else ""
        return f"{name}({self.sum(depth + 1)}{more})"

    def product(self, depth):
        text = self.random.choice(["", "", "-"]) + self.operand(depth)
        return text + self.random.choice(["", "", "^2", "^-1", "^3"])

    def sum(self, depth=0):
        text = self.product(depth)
        for _ in range(self.random.randrange(4 if depth < 2 else 2)):
            text += self.random.choice([" + ", " - ", " * ", " / "]) + self.product(depth)
        return text


def by_python(text, results):
    """What Python says of the text; units after a number are those of SI, and are left out."""
    text = re.sub(r"1 (?:m/s|rad/s|rad|m|N|s)\b", "1", text).replace("^", "**")
    for i, name in enumerate(RESULTS):
        text = text.replace(name, f"_{i}")
    values = {f"_{i}": results[name] for i, name in enumerate(RESULTS)}
    return float(eval(text, {"__builtins__": {}}, {**FUNCTIONS, **values}))


def of(result, name):
    return result.summary[f"rocket.1.{name}"]


class TestMeasures(Case):
    def test_expressions_are_those_of_python(self):
        results, counted = None, 0
        for seed in range(6):
            texts = Texts(seed)
            wanted = {f"e{i}": texts.sum() for i in range(400)}
            wanted = {name: text for name, text in wanted.items() if len(text) <= 400}
            wanted = dict(list(wanted.items())[:12])
            result = ld.Scenario.read(FIXED, {"run.end": "tip", "measures": wanted}).run()
            results = {name: of(result, name) for name in RESULTS}
            for name, text in wanted.items():
                try:
                    expected = by_python(text, results)
                except ZeroDivisionError:
                    expected = math.nan
                found = of(result, f"measure.{name}")
                if math.isnan(expected):
                    self.assertTrue(math.isnan(found), text)
                else:
                    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9,
                                               err_msg=text)
                counted += 1
        self.assertGreaterEqual(counted, 60)

    def test_figures_over_time_are_those_of_the_history(self):
        measures = {
            "swing": "largest(hypot(tip.y, tip.z))",
            "low": "least(tip.y * 2 - tip.z from t_release to t_rear)",
            "power": "mean(contact.rear.force * rocket.s_dot from t_front to t_rear)",
            "rate": "rms(tip.pitch_rate - tip.yaw_rate)",
            "way": "change(tip.pitch^2 from t_middle to t_rear)",
            "at": "(tip.y at t_front) / (tip.z at t_rear)"}
        result = ld.Scenario.read(FIXED, {"run.end": "tip", "run.output_step": "5 us",
                                          "measures": measures}).run()
        t = result["t"]

        def over(values, begin="t_ignition", end="t_rear"):
            inside = (t >= of(result, begin)) & (t <= of(result, end))
            return t[inside], values[inside]

        def mean(values, *window):
            times, inside = over(values, *window)
            steps = np.diff(times)
            return ((inside[1:] + inside[:-1]) / 2 * steps).sum() / (times[-1] - times[0])
        tip = {name: result[f"tip.{name}"] for name in ("y", "z", "pitch")}
        squares = over(tip["pitch"] ** 2, "t_middle")[1]
        expected = {
            "swing": over(np.hypot(tip["y"], tip["z"]))[1].max(),
            "low": over(2 * tip["y"] - tip["z"], "t_release")[1].min(),
            "power": mean(result["contact.rear.force"] * result["rocket.s_dot"], "t_front"),
            "rate": np.sqrt(mean((result["tip.pitch_rate"] - result["tip.yaw_rate"]) ** 2)),
            "way": np.abs(squares - squares[0]).max(),
            "at": np.interp(of(result, "t_front"), t, tip["y"])
            / np.interp(of(result, "t_rear"), t, tip["z"])}
        for name, value in expected.items():
            found = of(result, f"measure.{name}")
            print(f"    {name}: {found:.9g}, over the history {value:.9g}")
            np.testing.assert_allclose(found, value, rtol=3e-6, err_msg=name)

    def test_a_study_keeps_them(self):
        scenario = ld.Scenario.read(FIXED, {
            "measures": {"side": "hypot(yaw_rate, pitch_rate)", "fast": "exit_speed > 38 m/s",
                         "swing": "largest(abs(tip.y)) / 1 mm"},
            "scatter": {"samples": 400, "factors": {"rocket.mass": {"normal": "1 kg"}},
                        "until": {"measure.side.mean": "2 %"}},
            "sweep": {"tubes.slot": ["none"], "base.elevation": ["15 deg", "25 deg"]}})
        with ld.Study.of(scenario).run(self.folder / "study") as data:
            self.assertEqual(data.columns["measure.side"].unit, "rad/s")
            self.assertEqual(data.columns["measure.swing"].unit, "")
            values = data.values("measure.side", "yaw_rate", "pitch_rate", "measure.fast",
                                 "exit_speed", point=1)
            count = len(values["sample"])
            self.assertTrue(20 <= count < 200, count)
            np.testing.assert_allclose(values["measure.side"],
                                       np.hypot(values["yaw_rate"], values["pitch_rate"]),
                                       rtol=4e-16)
            np.testing.assert_array_equal(values["measure.fast"], values["exit_speed"] > 38)
            shown = command("study", "show", self.folder / "study", "--over", "base.elevation",
                            "--what", "measure.side")
            self.assertIn("measure.side", shown)

    def test_one_is_replaced_by_its_name(self):
        for given in ({"side": "yaw_rate"}, [{"side": "yaw_rate"}],
                      [{"name": "side", "expression": "yaw_rate"}]):
            result = ld.Scenario.read(FIXED, {"run.end": "tip", "measures": given,
                                              "measures.side": "2 * pitch_rate"}).run()
            self.assertEqual(of(result, "measure.side"), 2 * of(result, "pitch_rate"))

    def test_what_is_wrong_is_said(self):
        for text, why in (("exit_speed + tip.y", 'found m/s and m; expected one unit'),
                          ("exit_sped", 'did you mean "exit_speed"'),
                          ("mean(tip.x)", "is not a column")):
            with self.assertRaisesRegex(ld.InputError, why):
                ld.Scenario.read(EXAMPLES / "fixed.yaml", {"measures": {"a": text}})


if __name__ == "__main__":
    unittest.main()
