# python3 to_binary.py TEXT.crg BINARY.crg: the text file of bend.crg's layout in binary (KDBI)
import sys
import numpy as np

head, data = open(sys.argv[1]).read().replace("LRFI", "KDBI").split("$$$$\n")
lines = [f"{line:80}" for line in data.splitlines()]
grid = np.genfromtxt([a + b[:10] for a, b in zip(lines[::2], lines[1::2])], delimiter=10, comments=None)
open(sys.argv[2], "wb").write(f"{head}$$$$\n".encode() + np.append(grid, np.full(15, np.nan)).astype(">f8").tobytes())
