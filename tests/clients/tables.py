#!/usr/bin/env python3
"""pandas reads the table and NumPy the trajectories of one recording: usage tables.py TABLE.csv TRAJECTORIES.txt."""

import sys

import numpy as np
import pandas as pd

# Both files have at least this many correct decimals, m.
TOLERANCE_M = 1e-4


def main():
    table, trajectories_m = pd.read_csv(sys.argv[1]), np.loadtxt(sys.argv[2])
    agents = table["agent"].max() + 1
    assert not table.isna().any().any(), "the table has empty cells"
    assert trajectories_m.shape == (table["step"].max() + 1, 2 * agents), trajectories_m.shape
    table_m = table.sort_values(["step", "agent"])[["x_m", "y_m"]].to_numpy().reshape(trajectories_m.shape)
    difference_m = np.abs(table_m - trajectories_m).max()
    assert difference_m <= TOLERANCE_M, f"table and trajectories differ by {difference_m} m"
    print(f"pandas {pd.__version__}, NumPy {np.__version__}: {len(table)} rows of {agents} agents agree")


main()
