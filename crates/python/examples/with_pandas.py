"""A table of reports: cones against distortion, over the weight of cones."""

import sys

import pandas as pd

import seamstress_mesh as sm


def table(surface: sm.Surface, biases: list[float]) -> pd.DataFrame:
    """A row for each weight."""
    reports = [surface.parametrize(cone_bias=bias).report for bias in biases]
    columns = ["options.cone_bias", "cones.count", "distortion.tau", "distortion.symmetric_dirichlet"]
    return pd.json_normalize(reports)[columns].set_index("options.cone_bias")


if __name__ == "__main__":
    print(table(sm.read(sys.argv[1]), [0.0, 0.5, 2.0]))
