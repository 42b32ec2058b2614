"""Launch dynamics: a rocket that leaves a flexible tube, or a rail, on a moving base.

    import launchdyn as ld
    scenario = ld.Scenario.read("fixed.yaml")
    scenario["rocket.mass"] = "61 kg"
    result = scenario.run()
    result.summary["rocket.1.exit_speed"]     # a number in SI
    result["tip.y"]                             # a numpy array
    result.plot("tip.y", "tip.z")               # a figure

Numbers are in SI and radians throughout. Keys of a scenario: keys(); names of columns and numbers:
docs/quantities.md. Errors are LaunchdynError, with code, place and suggestion.
"""

from ._library import VERSION as __version__
from ._library import library as _found
from ._values import Key, keys
from .comparison import (ComparedResult, ComparedSeries, Comparison, Validation, compare)
from .derivatives import Derivative, Sensitivity, sensitivity
from .errors import (FileError, InputError, Interrupted, LaunchdynError, LaunchError, Message,
                     MissingError, NumericError, OutOfMemory, Status, UnknownName)
from .fitting import Fit, FittedKey, fit
from .multibody import (Assembly, Beam, Body, Energies, LoopJoint, Motion, Multibody, Place,
                        Reactions, Section, Vibration)
from .optimising import OptimisedKey, Optimum, optimise
from .response import Loop, LoopPoints, Margins, Response, Scatter, Strength
from .result import Column, History, Quantity, Result, Summary
from .scenario import Scenario
from .simulation import (BaseFrame, Event, EventKind, Mode, Pole, Run, Simulation, VehicleRun,
                         Wrench)
from .study import (Cell, Cells, Counts, Estimate, Footprint, Influence, Point, Statistics, Study,
                    StudyColumn, StudyData, merge_shards, write_report)
from .views import View, draw, figures


def library_version() -> str:
    """The version of the library that was found, "0.1.0".

    >>> ld.library_version() == ld.__version__
    True
    """
    return str(_found.ld_version().decode())


__all__ = [
    "Assembly", "BaseFrame", "Beam", "Body", "Cell", "Cells", "Column", "ComparedResult",
    "ComparedSeries", "Comparison", "Counts", "Derivative", "Energies", "Estimate",
    "Event", "EventKind", "FileError", "Fit", "FittedKey", "Footprint", "History",
    "Influence", "InputError", "Interrupted", "Key", "LaunchError", "LaunchdynError",
    "Loop", "LoopJoint", "LoopPoints", "Margins", "Message", "MissingError", "Mode",
    "Motion", "Multibody", "NumericError", "OptimisedKey", "Optimum", "OutOfMemory",
    "Place", "Point", "Pole", "Quantity", "Reactions", "Response", "Result", "Run",
    "Scatter", "Scenario", "Section", "Sensitivity", "Simulation", "Statistics", "Status",
    "Strength", "Study", "StudyColumn", "StudyData", "Summary", "UnknownName",
    "Validation", "VehicleRun", "Vibration", "View", "Wrench", "__version__", "compare",
    "draw", "figures", "fit", "keys", "library_version", "merge_shards", "optimise",
    "sensitivity", "write_report",
]
