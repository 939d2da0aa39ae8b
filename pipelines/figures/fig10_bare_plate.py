# SPDX-License-Identifier: GPL-3.0-or-later
"""A single track on bare 316L: simulated section, with the measured width and depth."""

import argparse

import artifact
import matplotlib.pyplot as plt
import sections
import style


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("run", help="run.h5 of the bare track")
    arguments.add_argument("result", help="its result.json")
    arguments.add_argument("comparison", help="validation.json with the rows bare_316l_width and bare_316l_depth")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    result = artifact.read_json(given.result)
    rows = {row["name"]: row for row in artifact.value(artifact.read_json(given.comparison), "rows", given.comparison)}
    quantities = [(word, artifact.value(result, f"fusion_{word}_um", given.result),
                   artifact.value(rows, f"bare_316l_{word}", given.comparison)) for word in ("width", "depth")]

    figure, (section, explained, bars) = plt.subplots(1, 3, figsize=(style.PAGE_WIDTH, 2.5),
                                                      width_ratios=[30, 1, 16])
    with artifact.open_artifact(given.run, "meltproof run") as run:
        last = artifact.snapshots(run)[-1]
        liquidus = artifact.scalar(run, "reference_temperature")
        middle = 0.6 * artifact.scalar(run, "scan_speed") * artifact.scalar(run, "exposure")
        sections.plot_field(section, explained, run, last, "peak_temperature", "x", "highest temperature [K]",
                            liquidus, at=middle)
    section.set_title("a  Section across the track; line: liquidus")

    sentences = []
    for index, (word, simulated, row) in enumerate(quantities):
        bars.bar(index - 0.18, simulated, 0.32, facecolor=style.SKY, edgecolor="black", linewidth=0.6,
                 label="simulated" if index == 0 else None)
        if row["D"] is None:
            sentences.append(f"{word}: {simulated:.0f} um simulated, measurement {row['verdict']}")
            continue
        bars.bar(index + 0.18, row["D"], 0.32, yerr=2 * (row["u_D"] or 0), capsize=3, facecolor="white",
                 edgecolor="black", linewidth=0.6, hatch="////", label="measured (k = 2)" if index == 0 else None)
        sentences.append(f"{word}: {simulated:.0f} um simulated, {row['D']:.0f} um measured with a standard "
                         f"uncertainty of {row['u_D'] or 0:.0f} um: {row['verdict']}")
    bars.set_xticks(range(len(quantities)), [f"track {word}" for word, _, _ in quantities])
    bars.set_ylabel("length [um]")
    bars.grid(axis="x", visible=False)
    bars.set_title("b  Against the measurement")
    bars.legend(loc="upper right")
    source = quantities[0][2].get("source") or "see the comparison table"
    style.save(figure, given.output, "A single track on bare 316L",
               f"{result['title']}. " + "; ".join(sentences) + f". Measurement: {source}.")


style.run(main)
