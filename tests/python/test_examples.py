"""Every public name has an example in its docstring, which runs, and names its parameters."""

import doctest
import inspect
import re
import unittest

import launchdyn as ld
import numpy as np
from support import EXAMPLES, FIXED, Case, external, needs

LAUNCHES = "t_front [ms],t_front_u [ms],t_rear [ms],t_rear_u [ms]\n95.0,0.1,157.5,0.1\n"
LEAST = {"over": {"rocket.lock.release_force": ["2 kN", "10 kN"]}, "evaluations": 4,
         "least": {"take": "mean", "of": "t_rear"}}
QUICK = {"tubes.modes.bending": 1, "tubes.modes.torsion": 1, "run.tolerance": 1e-4,
         "run.max_step": "1 ms"}


def functions(of, prefix):
    """Public functions and properties of a class, by their names."""
    for name, value in vars(of).items():
        value = getattr(value, "__func__", getattr(value, "fget", value))
        value = getattr(value, "func", value)  # a cached property
        if not name.startswith("_") and inspect.isfunction(value):
            yield f"{prefix}.{name}", value


def public():
    """The public names: what they stand for."""
    found = {name: getattr(ld, name) for name in ld.__all__ if name != "__version__"}
    for name, value in list(found.items()):
        if inspect.isclass(value):
            found.update(functions(value, name))
    return found


class Examples(Case):
    def names(self):
        """What stands for something in the examples."""
        scenario, vehicle = ld.Scenario.read(FIXED), ld.Scenario.read(EXAMPLES / "reference.yaml")
        student = ld.Scenario.read(EXAMPLES / "student-rocket/student-rocket.yaml")
        flown = student.run(out=self.folder / "student")
        log = EXAMPLES / "student-rocket/measured.csv"
        flight = ld.Scenario.read(EXAMPLES / "flight.yaml")
        swept = flight.derive({
            "scatter.samples": 8, "scatter.factors": {"rocket.mass_error": {"normal": "0.1 kg"}},
            "sweep": {"rocket.mass": ["60 kg", "61 kg"]}})
        launches = self.folder / "launches.csv"
        launches.write_text(LAUNCHES)
        quick = scenario.derive(QUICK)
        asking = quick.derive({"optimise": LEAST})
        fitted = ld.fit(quick, launches, {"rocket.motor.thrust_scale": (0.9, 1.1)}, starts=1)
        with self.assertRaises(ld.InputError) as caught:
            ld.Scenario.from_text("include: fixed.yaml\nrocket:\n  mas: 61 kg\n", name="mine.yaml",
                                  folder=EXAMPLES)
        study = ld.Study.of(swept)
        data = study.run(self.folder / "data")
        return {
            "ld": ld, "np": np, "folder": self.folder, "examples": EXAMPLES, "scenario": scenario,
            "result": scenario.run(), "vehicle": vehicle, "response": vehicle.response(),
            "external": external(), "flown": flown, "swept": swept, "study": study,
            "data": data, "landings": data, "launches": launches, "quick": quick,
            "fitted": fitted, "asking": asking, "optimum": ld.optimise(asking),
            "log": log, "compared": ld.compare(self.folder / "student", log),
            "error": caught.exception,
            "pendulum": ld.Multibody([ld.Body("bob", hinge="revolute", axis=(0, 0, 1), mass=1,
                                              center=(-1, 0, 0))]),
            "windy": flight.derive({"environment.wind.speed": "5 m/s"}),
        }

    @needs("matplotlib")
    @needs("pandas")
    @needs("xarray")
    def test_the_examples_run(self):
        given = self.names()
        parser, said = doctest.DocTestParser(), []
        runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
        for name, value in public().items():
            example = parser.get_doctest(inspect.getdoc(value), dict(given), name, None, None)
            runner.run(example, out=said.append)
        self.assertEqual(runner.summarize(verbose=False).failed, 0, "".join(said))
        self.assertGreater(runner.tries, len(public()))

    def test_every_public_name_has_an_example(self):
        without = [name for name, value in public().items()
                   if ">>> " not in (inspect.getdoc(value) or "")]
        self.assertEqual(without, [])

    def test_parameters_are_named(self):
        unnamed = []
        for name, value in public().items():
            if inspect.isfunction(value):
                told = inspect.getdoc(value)
                unnamed += [f"{name}: {given}" for given in inspect.signature(value).parameters
                            if given not in ("self", "cls") and
                            not re.search(rf"\b{given}\b", told)]
        self.assertEqual(unnamed, [])


if __name__ == "__main__":
    unittest.main()
