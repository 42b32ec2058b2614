# python3 crg.py FILE.crg V_LEFT V_RIGHT U0: heights of an OpenCRG road on two tracks, v [m] positive to the left,
# at x = u - U0 [m]
import re
import sys
import numpy as np

name, tracks, u0 = sys.argv[1], np.array(sys.argv[2:4], float), float(sys.argv[4])
head, mark, data = open(name, "rb").read().partition(b"\n$$$$")
head, data = re.sub(r"(?m)^\*.*|!.*", "", head.decode("latin-1")).lower(), data.partition(b"\n")[2]
if not mark or re.search(r"(?m)^\s*scale_", head):
    sys.exit(f"{name}: the road is in another file or scaled by modifiers: not read here")
value = {key: float(number) for key, number in re.findall(r"(?m)^\s*((?:reference|long)_\w+)\s*=\s*(\S+)", head)}
kind, channels = (re.findall(r"(?m)^#:\s*(\w+)", head) or ["krbi"])[0], re.findall(r"(?m)^d:\s*([^,\n]*)", head)
width = {"lrfi": 10, "ldfi": 20, "krbi": 4, "kdbi": 8}[kind]
if kind[0] == "l":  # text of 80 characters a line, where each row of the grid begins a new line
    lines = [f"{line:80}" for line in data.decode("latin-1").splitlines() if line.strip()]
    each = -(-len(channels) * width // 80)
    rows = ["".join(lines[i:i + each])[:width * len(channels)] for i in range(0, len(lines), each)]
    grid = np.genfromtxt(rows, delimiter=width, comments=None)
else:  # big-endian numbers one after the other, missing values behind the last
    whole = len(data) // (width * len(channels)) * len(channels)
    grid = np.frombuffer(data, f">f{width}", whole).astype(float).reshape(-1, len(channels))
    grid = grid[:np.flatnonzero(~np.isnan(grid).all(axis=1))[-1] + 1]
listed = [float(channel.split("=")[1]) for channel in channels if "at v" in channel]
sections = np.array([channel.startswith("long section") for channel in channels])
v = np.array(listed) if listed else (value["long_section_v_right"] +
                                     value["long_section_v_increment"] * np.arange(sections.sum()))
if (np.diff(v) <= 0).any() or not v[0] <= tracks.min() <= tracks.max() <= v[-1]:
    sys.exit(f"{name}: the sections, v = {v[0]:g} m to {v[-1]:g} m, do not rise, or a track is beyond them")
slope, banking = (grid[:, channels.index(f"reference line {key}")] if f"reference line {key}" in channels
                  else np.full(len(grid), value.get(f"reference_line_start_{key[0]}", 0))
                  for key in ("slope", "banking"))
u = value.get("reference_line_start_u", 0) + value["reference_line_increment"] * np.arange(len(grid))
z = np.array([np.interp(tracks, v, row) for row in grid[:, sections]]) + np.outer(banking, tracks)
z[1:] += np.cumsum(slope[1:] * np.diff(u))[:, None]
if np.isnan(z).any():
    sys.exit(f"{name}: a height is missing at u = {u[np.isnan(z).any(axis=1)][0]:g} m")
np.savetxt(sys.stdout, np.column_stack((u - u0, z)), "%.9g", ", ", header="x [m], left [m], right [m]", comments="")
