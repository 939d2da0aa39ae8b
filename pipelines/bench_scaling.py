# SPDX-License-Identifier: GPL-3.0-or-later
"""What more ranks would do: a model fitted to what runs on a few ranks sent and how evenly their work lay.

An acoustic step on P ranks takes t(P) = t1/P * U(P) + c C(P) t1/N + M L + B(P)/W + R L log2 P. t1 is the time on one
rank, measured, N the particles. C are the copies on a rank; of them the state is computed but none of the sums, so they
cost the share c that the state has in a step on one rank, measured. U is by how much the parts of a step are uneven among
the ranks, 1 + u log2 P; M the messages of a rank and B their bytes, b P^-e, C likewise; all fitted to the runs. L and W
are of the network, and assumed: nobody measured one here; R counts the steps in which all ranks agree on one number.
Several ranks on too few cores tell all of these but the time.

Strong scaling is the same case on more ranks. Weak scaling is a case refined so that a rank keeps as many particles as it
has of this one on WEAK_RANKS: copies, messages and bytes of a rank stay as they are there, U grows, and the efficiency is
the time of one such rank's particles alone over the time of a step.
"""

import math

LATENCY = 2e-6  # s, of a message; assumed: a present-day cluster's network
BANDWIDTH = 10e9  # bytes a second of a rank; assumed likewise
WEAK_RANKS = 2  # whose particles a rank has in the weak scaling
AGREEMENTS = 1.5  # an acoustic step has one, a thermal one several


def slope(points):
    """Least squares y = a + b x; returns (a, b). One point: b = 0."""
    count = len(points)
    mean_x, mean_y = sum(x for x, _ in points) / count, sum(y for _, y in points) / count
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    b = sum((x - mean_x) * (y - mean_y) for x, y in points) / spread if spread > 0 else 0.0
    return mean_y - b * mean_x, b


def fit(runs):
    """Of the details of runs on 2 ranks and more, by number of ranks, all of the same case."""
    uneven = [(math.log2(run["ranks"]), run["largest_over_mean_work"] - 1) for run in runs]
    # Through the origin: one rank is as even as can be.
    per_doubling = sum(x * y for x, y in uneven) / sum(x * x for x, _ in uneven)
    start, exponent = slope([(math.log(run["ranks"]), math.log(run["bytes_per_rank_and_acoustic_step"])) for run in runs])
    copies, copies_exponent = slope([(math.log(run["ranks"]), math.log(run["most_copies_on_a_rank"])) for run in runs])
    return {"copies": math.exp(copies), "copies_exponent": copies_exponent, "uneven_per_doubling": per_doubling,
            "bytes": math.exp(start), "bytes_exponent": exponent,
            "messages": max(run["messages_per_rank_and_acoustic_step"] for run in runs),
            "copy_cost": sum(run["parts_on_one_s"]["state"] for run in runs)
                         / sum(sum(run["parts_on_one_s"].values()) for run in runs)}


def step_time(model, one, particles, ranks, divided_by=None):
    """Seconds of an acoustic step on so many ranks.

    particles, of which one rank takes `one` seconds, are divided by `divided_by`, or by the ranks themselves: what a rank
    has. With another number than the ranks' the whole case is larger by their ratio.
    """
    divided_by = divided_by or ranks
    if ranks == 1:
        return one / divided_by
    doublings = math.log2(ranks)
    copies = model["copies"] * divided_by ** model["copies_exponent"]
    return (one / divided_by * (1 + model["uneven_per_doubling"] * doublings)
            + model["copy_cost"] * copies * one / particles
            + model["messages"] * LATENCY + model["bytes"] * divided_by ** model["bytes_exponent"] / BANDWIDTH
            + AGREEMENTS * doublings * LATENCY)


def scaling(details):
    """The model and what it says, or None without runs on several ranks."""
    runs = sorted((found for name, found in details.items() if name.startswith("ranks_")), key=lambda run: run["ranks"])
    if not runs:
        return None
    two = runs[0]
    one = sum(two["seconds_on_one"]) / two["acoustic_steps"]
    model = fit(runs)
    said = []
    for ranks in (2, 8, 64, 1024):
        strong = one / step_time(model, one, two["particles"], ranks)
        weak = one / WEAK_RANKS / step_time(model, one, two["particles"], ranks, WEAK_RANKS)
        said.append({"ranks": ranks, "strong_speedup": strong, "strong_efficiency": strong / ranks,
                     "weak_efficiency": weak})
    return {"particles": two["particles"], "weak_particles_per_rank": two["particles"] / WEAK_RANKS, "seconds_per_acoustic_step_on_one_rank": one, "model": model,
            "assumed_latency_s": LATENCY, "assumed_bandwidth_B_per_s": BANDWIDTH, "fitted_to_ranks": [r["ranks"] for r in runs],
            "says": said}


def scaling_lines(found):
    """For people to read."""
    return [f"model of more ranks, {found['particles']} particles, network "
            f"assumed ({1e6 * LATENCY:g} us, {1e-9 * BANDWIDTH:g} GB/s):",
            *(f"  {row['ranks']:5d} ranks: {row['strong_speedup']:.3g} times as fast, "
              f"{100 * row['strong_efficiency']:.0f} % of ideal; with {found['weak_particles_per_rank']:.0f} particles "
              f"on every rank {100 * row['weak_efficiency']:.0f} %" for row in found["says"])]
