"""A thousand launches of the fixed launcher, each with another mass, by the Python package: what
bench/bench_launches.c does by the C interface.

    PYTHONPATH=python python3 bench/launches.py [COUNT]
"""

import sys
import time
from pathlib import Path

import launchdyn as ld

count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
scenario = ld.Scenario.read(Path(__file__).parents[1] / "examples/fixed.yaml")
total = 0.0
start = time.process_time()
for i in range(count):
    scenario["rocket.mass"] = 60 + i * 1e-3
    result = scenario.run()
    total += result.summary["rocket.1.exit_speed"] + result["tip.y"][-1]
print(f"{count} launches by the Python package: {time.process_time() - start:.2f} s of CPU time "
      f"(sum {total:.17g})")
