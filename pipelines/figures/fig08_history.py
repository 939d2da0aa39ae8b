# SPDX-License-Identifier: GPL-3.0-or-later
"""How the melt pool grows: length against time for every track."""

import argparse
from pathlib import Path

import artifact
import matplotlib.pyplot as plt
import style


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("results", nargs="+", help="result.json of each track; history.csv stands beside it")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    figure, (lengths, temperatures) = plt.subplots(1, 2, figsize=(style.PAGE_WIDTH, 2.5))
    sentences = []
    for look, path in zip(style.SERIES, given.results):
        result = artifact.read_json(path)
        table_path = Path(path).parent / "history.csv"
        table = artifact.read_table(table_path)
        time = artifact.column(table, "time", table_path)
        every = max(1, len(time) // 8)
        label = result["title"]
        plain = {key: look[key] for key in ("color", "linestyle", "marker")}
        lengths.plot(time, artifact.column(table, "pool_length", table_path), label=label, markevery=every,
                     fillstyle="none", **plain)
        temperatures.plot(time, artifact.column(table, "peak_temperature", table_path), markevery=every,
                          fillstyle="none", **plain)
        growth = result.get("pool_length_growth_um_per_ms")
        if growth is not None:
            sentences.append(f"{label}: {growth:+.0f} um/ms")
    lengths.set(xlabel="time [us]", ylabel="length of the connected pool [um]", ylim=(0, None))
    lengths.set_title("a  Length above the liquidus of 316L")
    lengths.legend(loc="best", fontsize=6)
    temperatures.set(xlabel="time [us]", ylabel="peak temperature [K]", ylim=(0, None))
    temperatures.set_title("b  Highest temperature")
    style.save(figure, given.output, "The melt pool in time",
               "Simulated. Whether a pool is steady is a claim to be tested: the growth of its length over the "
               "averaging window is, " + "; ".join(sentences) + ".")


style.run(main)
