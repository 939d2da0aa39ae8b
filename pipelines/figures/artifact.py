# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading artifacts: HDF5, JSON and CSV. What is missing is said in a sentence that names file and key."""

import csv
import json
import math
from pathlib import Path

import h5py
import numpy as np


class MissingArtifact(Exception):
    """A file, key, column or data set that a figure or the report needs is not there."""


def existing(path):
    path = Path(path)
    if not path.is_file():
        raise MissingArtifact(f"{path} does not exist; `make validate` makes it.")
    return path


def read_json(path):
    path = existing(path)
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except ValueError as problem:
        raise MissingArtifact(f"{path} is no JSON file ({problem}); remove it and run `make validate`.") from None


def value(record, key, path):
    """record[key]; `path` names the file in the message."""
    if not hasattr(record, "keys") or key not in record:
        raise MissingArtifact(f"{path} has no key `{key}`, which is needed here.")
    return record[key]


def read_table(path):
    """A CSV file as {column header: array}; empty cells are NaN. Lines that begin with # are skipped."""
    path = existing(path)
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    if len(rows) < 2:
        raise MissingArtifact(f"{path} holds no rows.")
    columns = {}
    for index, header in enumerate(rows[0]):
        cells = [row[index].strip() if index < len(row) else "" for row in rows[1:]]
        try:
            columns[header.strip()] = np.array([float(cell) if cell else math.nan for cell in cells])
        except ValueError:
            columns[header.strip()] = np.array(cells)
    return columns


def column(table, name, path):
    """The column `name`, with its unit as in `pool_length [um]`, or without the unit if that is unique."""
    if name in table:
        return table[name]
    matches = [header for header in table if header.split(" [")[0] == name]
    if len(matches) != 1:
        raise MissingArtifact(f"{path} has no column `{name}`; it has: {', '.join(table)}.")
    return table[matches[0]]


def open_artifact(path, kind):
    """An HDF5 artifact of the suite, open for reading."""
    path = existing(path)
    try:
        file = h5py.File(path, "r")
    except OSError:
        raise MissingArtifact(f"{path} is no HDF5 file; remove it and run `make validate`.") from None
    found = text(file.attrs.get("kind", ""))
    if kind and found != kind:
        file.close()
        raise MissingArtifact(f"{path} is a '{found}', where a '{kind}' is needed.")
    return file


def text(attribute):
    return attribute.decode() if isinstance(attribute, bytes) else str(attribute)


def data(file, name):
    """A whole data set as an array."""
    if name not in file:
        raise MissingArtifact(f"{file.filename} has no data set `{name}`, which is needed here.")
    return file[name][...]


def scalar(file, name):
    return float(np.asarray(data(file, name)).reshape(-1)[0])


def snapshots(file):
    """The names of a run's snapshots in the order of time."""
    if "snapshots" not in file or not len(file["snapshots"]):
        raise MissingArtifact(f"{file.filename} holds no snapshots.")
    return [f"snapshots/{name}" for name in sorted(file["snapshots"])]
