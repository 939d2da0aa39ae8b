# SPDX-License-Identifier: GPL-3.0-or-later
"""What more ranks would do: a model fitted to what runs on a few ranks sent and how evenly their work lay.

An acoustic step on P ranks takes t(P) = t1/P * U(P) + c C(P) t1/N + M L + B(P)/W + R L log2 P. t1 is the time on one
rank, measured, N the particles. C are the copies on a rank, which cost the share c of what a particle costs. U is by how much the parts of a step are uneven among the ranks, 1 + u log2 P; M the messages of a rank and B their
bytes, b P^-e, C likewise; all fitted to the runs. L and W are of the network, and assumed: nobody measured one here; R counts the
steps in which all ranks agree on one number. Several ranks on too few cores tell all of these but the time.
"""

import math

LATENCY = 2e-6  # s, of a message; assumed: a present-day cluster's network
BANDWIDTH = 10e9  # bytes a second of a rank; assumed likewise
COPY_COST = 0.2  # of a particle's: its state is computed, none of its sums; about the share of "state" in a step
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
            "messages": max(run["messages_per_rank_and_acoustic_step"] for run in runs)}


def step_time(model, one, particles, ranks):
    """Seconds of an acoustic step of so many particles in all, of which one rank takes `one`."""
    if ranks == 1:
        return one
    doublings = math.log2(ranks)
    copies = model["copies"] * ranks ** model["copies_exponent"]
    return (one / ranks * (1 + model["uneven_per_doubling"] * doublings) + COPY_COST * copies * one / particles
            + model["messages"] * LATENCY + model["bytes"] * ranks ** model["bytes_exponent"] / BANDWIDTH
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
        said.append({"ranks": ranks, "strong_speedup": strong, "strong_efficiency": strong / ranks})
    return {"particles": two["particles"], "seconds_per_acoustic_step_on_one_rank": one, "model": model,
            "assumed_latency_s": LATENCY, "assumed_bandwidth_B_per_s": BANDWIDTH, "fitted_to_ranks": [r["ranks"] for r in runs],
            "says": said}


def scaling_lines(found):
    """For people to read."""
    return [f"model of more ranks, {found['particles']} particles, network "
            f"assumed ({1e6 * LATENCY:g} us, {1e-9 * BANDWIDTH:g} GB/s):",
            *(f"  {row['ranks']:5d} ranks: {row['strong_speedup']:.3g} times as fast, "
              f"{100 * row['strong_efficiency']:.0f} % of ideal" for row in found["says"])]
