# SPDX-License-Identifier: GPL-3.0-or-later
"""One frame of the virtual camera, and the melt pool that the thermography program finds in it."""

import argparse

import artifact
import matplotlib.pyplot as plt
import numpy as np
import style


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("recording", help="recording.h5 of meltproof-camera")
    arguments.add_argument("summary", help="summary.json of meltproof-thermography")
    arguments.add_argument("--output", required=True, help="the SVG file to write")
    given = arguments.parse_args()

    summary = artifact.read_json(given.summary)
    with artifact.open_artifact(given.recording, "meltproof recording") as recording:
        frames = artifact.data(recording, "frames")
        pixel = 1e6 * artifact.scalar(recording, "pixel_size")
        rate = artifact.scalar(recording, "frame_rate")
        integration = 1e6 * artifact.scalar(recording, "integration_time")
        synthetic = artifact.text(recording.attrs.get("synthetic", ""))
    found = summary.get("melt_pool_found") and "shown_frame" in summary
    shown = int(summary["shown_frame"]) if found else int(np.argmax(frames.reshape(len(frames), -1).max(axis=1)))
    frame = frames[shown].astype(float)

    figure, axes = plt.subplots(figsize=(style.PAGE_WIDTH, 3.0))
    height, width = frame.shape
    columns, rows = np.arange(width + 1) * pixel, np.arange(height + 1) * pixel
    picture = axes.pcolormesh(columns, rows, frame, cmap=style.FIELD_COLOURS, rasterized=False, edgecolors="face",
                              linewidth=0.1)
    level = summary.get("level", {}).get("value")
    if found and level is not None:
        centres = (np.arange(width) + 0.5) * pixel, (np.arange(height) + 0.5) * pixel
        axes.contour(*centres, frame, levels=[level], colors="white", linewidths=1.6)
        axes.contour(*centres, frame, levels=[level], colors="black", linewidths=0.6, linestyles="--")
    axes.set(aspect="equal", ylim=(height * pixel, 0), xlabel="scan direction in the image [um]",
             ylabel="down in the image [um]")
    axes.grid(False)
    axes.set_title(f"Frame {shown} of {len(frames)}, synthetic; line: edge of the pool" if found
                   else f"Frame {shown} of {len(frames)}, synthetic; no melt pool was found")
    figure.colorbar(picture, ax=axes, label=f"signal [{'count' if frames.dtype.kind in 'iu' else 'K'}]", pad=0.01,
                    aspect=14)

    if found and "length_um" in summary:
        length, depth = summary["length_um"], summary["depth_um"]
        measured = (f" Over {length['n']} frames ({summary.get('frames_used', '')}) the length is "
                    f"{length['mean']:.0f} um (standard deviation {length['sd']:.0f} um, uncertainty of the mean "
                    f"{length['u_mean']:.1f} um), the depth {depth['mean']:.0f} um.")
    else:
        measured = f" {summary.get('reason') or 'No melt pool was found in it.'}"
    style.save(figure, given.output, "What the camera of the experiment would see",
               f"SYNTHETIC: {synthetic.rstrip('.')}. {width} x {height} px of {pixel:.1f} um at {rate:.1f} Hz, "
               f"integration {integration:.0f} us, from the side." + measured)


style.run(main)
