# SPDX-License-Identifier: GPL-3.0-or-later
"""Cooling rate behind a simulated pool, as AM-Bench 2018-02 takes it from a camera's frames.

On the surface's centre line the distance of two isotherms behind the pool, times the scan speed, gives
the time in which the metal cools from one to the other: rate = v (T1 - T2) / (x1 - x2).
"""

import argparse
import json
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "figures"))
import artifact  # noqa: E402
import numpy as np  # noqa: E402

ZERO_CELSIUS = 273.15


def centre_line(run, snapshot, spacing):
    """x and T of slices of one spacing along y = 0: the mean over the upper two spacings of the metal within two
    spacings of the centre, because single particles of the surface stand at different heights."""
    position = artifact.data(run, f"{snapshot}/position")
    temperature = artifact.data(run, f"{snapshot}/temperature")
    middle = np.abs(position[:, 1]) <= 2 * spacing
    x, z, warm = position[middle, 0], position[middle, 2], temperature[middle]
    slices = np.round(x / spacing).astype(int)
    place, mean = [], []
    for number in np.unique(slices):
        inside = slices == number
        top = z[inside] >= z[inside].max() - 2 * spacing
        place.append(number * spacing)
        mean.append(warm[inside][top].mean())
    return np.array(place), np.array(mean)


def crossing_behind(x, temperature, level, hottest):
    """The first place behind the hottest one where the temperature falls below `level`; None if it does not."""
    for right in range(hottest, 0, -1):
        left = right - 1
        if temperature[right] >= level > temperature[left]:
            share = (temperature[right] - level) / (temperature[right] - temperature[left])
            return x[right] + share * (x[left] - x[right])
    return None


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("run", help="run.h5")
    arguments.add_argument("--from-celsius", type=float, default=1290.0)
    arguments.add_argument("--to-celsius", type=float, default=1190.0)
    arguments.add_argument("--share", type=float, default=1 / 3, help="last part of the exposure that counts")
    arguments.add_argument("--output", required=True, help="the JSON file to write")
    given = arguments.parse_args()

    rates, times = [], []
    with artifact.open_artifact(given.run, "meltproof run") as run:
        spacing, speed = artifact.scalar(run, "spacing"), artifact.scalar(run, "scan_speed")
        exposure = artifact.scalar(run, "exposure")
        for snapshot in artifact.snapshots(run):
            time = artifact.scalar(run, f"{snapshot}/time")
            if not (1 - given.share) * exposure <= time <= exposure:
                continue
            x, temperature = centre_line(run, snapshot, spacing)
            hottest = int(np.argmax(temperature))
            ends = [crossing_behind(x, temperature, celsius + ZERO_CELSIUS, hottest)
                    for celsius in (given.from_celsius, given.to_celsius)]
            if None not in ends and ends[0] > ends[1]:
                rates.append(speed * (given.from_celsius - given.to_celsius) / (ends[0] - ends[1]))
                times.append(1e6 * time)
    if len(rates) < 2:
        raise artifact.MissingArtifact(f"{given.run} holds {len(rates)} snapshots in the last {given.share:.2g} of the "
                                       "exposure with both isotherms on the surface; at least 2 are needed.")
    result = {"cooling_rate_K_s": float(np.mean(rates)), "cooling_rate_sd_K_s": float(np.std(rates, ddof=1)),
              "snapshots": len(rates), "from_us": min(times), "to_us": max(times),
              "from_celsius": given.from_celsius, "to_celsius": given.to_celsius,
              "spacing_um": 1e6 * spacing}
    output = Path(given.output)
    partial = output.with_suffix(".tmp")
    partial.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    os.replace(partial, output)


if __name__ == "__main__":
    try:
        main()
    except artifact.MissingArtifact as problem:
        print(f"cooling_rate.py: error: {problem}", file=sys.stderr)
        sys.exit(2)
