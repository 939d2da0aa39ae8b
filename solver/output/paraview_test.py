# SPDX-License-Identifier: GPL-3.0-or-later
"""What ParaView sees is what run.h5 holds: a small run is opened with Debian's VTK and compared with h5py.

Debian's VTK reads .vtu; its XDMF readers come with ParaView alone (python3-paraview, which excludes
python3-vtk9), so the XDMF file is opened with them where they are installed, and its references are checked
against run.h5 everywhere. python3-vtk9 is required: without it the test fails."""

import csv
import os
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

try:
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
    from vtkmodules.vtkIOXdmf3 import vtkXdmf3Reader
    XDMF_READERS = [vtkXdmfReader, vtkXdmf3Reader]
except ImportError:
    XDMF_READERS = []

BIN = Path(os.environ["MELTPROOF_BIN"])
CASE = ["solver/cases/track_316L_175W_750.toml", "--threads", "1", "--quiet", "--set", "spacing=\"16 um\"",
        "--set", "laser.exposure=\"0.12 ms\"", "--set", "domain.width=\"240 um\"", "--set", "domain.depth=\"112 um\"",
        "--set", "output.cooling_limit=\"0.1 ms\""]


def name_of(dataset):
    units = dataset.attrs["units"]
    units = units.decode() if isinstance(units, bytes) else units
    name = dataset.name.split("/")[-1]
    return name if units == "1" else f"{name} [{units}]"


class ParaView(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="meltproof_paraview_")
        cls.run_folder = Path(cls.folder.name)
        run = cls.run_folder / "run.h5"
        subprocess.run([BIN / "meltproof-solve", *CASE, "--output", cls.run_folder], check=True)
        subprocess.run([BIN / "meltproof-export", "--quiet", run, "--vtu", cls.run_folder / "vtu",
                        "--exaca", cls.run_folder / "exaca.csv", "--gradient", cls.run_folder / "gradient.csv"],
                       check=True)
        cls.file = h5py.File(run, "r")
        cls.groups = [cls.file["snapshots"][name] for name in sorted(cls.file["snapshots"])]

    @classmethod
    def tearDownClass(cls):
        cls.file.close()
        cls.folder.cleanup()

    def fields(self, group):
        """Every data set that is one value or vector per particle."""
        count = len(group["identity"])
        return [d for d in group.values() if d.shape[:1] == (count,) and d.name.split("/")[-1] != "position"]

    def compare(self, grid, group):
        count = len(group["identity"])
        self.assertEqual(grid.GetNumberOfPoints(), count)
        self.assertGreater(grid.GetNumberOfCells(), 0, "without cells ParaView draws nothing")
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), group["position"][...])
        fields = self.fields(group)
        self.assertGreaterEqual(len(fields), 14)
        self.assertEqual(grid.GetPointData().GetNumberOfArrays(), len(fields))
        for field in fields:
            array = grid.GetPointData().GetArray(name_of(field))
            self.assertIsNotNone(array, name_of(field))
            np.testing.assert_array_equal(vtk_to_numpy(array), field[...], name_of(field))
            if field.ndim == 1:
                self.assertEqual(array.GetRange(), (field[...].min(), field[...].max()))

    def test_vtk_opens_the_vtu_series_with_its_times(self):
        sets = xml.parse(self.run_folder / "vtu" / "run.pvd").getroot().findall("./Collection/DataSet")
        self.assertEqual(len(sets), len(self.groups))
        for entry, group in zip(sets, self.groups):
            self.assertAlmostEqual(float(entry.get("timestep")), group["time"][()], delta=1e-15)
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(self.run_folder / "vtu" / entry.get("file")))
            reader.Update()
            self.compare(reader.GetOutput(), group)

    def test_every_reference_of_the_xdmf_file_fits_run_h5(self):
        grids = xml.parse(self.run_folder / "run.xdmf").getroot().findall("./Domain/Grid/Grid")
        self.assertEqual(len(grids), len(self.groups))
        kinds = {("Float", "4"): "<f4", ("Float", "8"): "<f8", ("Int", "4"): "<i4", ("Int", "8"): "<i8",
                 ("UChar", "1"): "|u1"}
        for grid, group in zip(grids, self.groups):
            self.assertAlmostEqual(float(grid.find("Time").get("Value")), group["time"][()], delta=1e-15)
            self.assertEqual(len(grid.findall("Attribute")), len(self.fields(group)))
            for item in grid.iter("DataItem"):
                file, path = item.text.split(":")
                self.assertEqual(file, "run.h5")
                data = self.file[path]
                self.assertEqual(data.parent, group)
                self.assertEqual(tuple(int(n) for n in item.get("Dimensions").split()), data.shape)
                self.assertEqual(kinds[item.get("NumberType"), item.get("Precision")], data.dtype.str)
            for attribute in grid.findall("Attribute"):
                data = self.file[attribute.find("DataItem").text.split(":")[1]]
                self.assertEqual(attribute.get("Name"), name_of(data))
            cells = self.file[grid.find("Topology/DataItem").text.split(":")[1]]
            np.testing.assert_array_equal(cells[...], np.arange(len(cells)))

    @unittest.skipUnless(XDMF_READERS, "the XDMF readers come with python3-paraview")
    def test_paraviews_readers_open_the_xdmf_file(self):
        for kind in XDMF_READERS:
            reader = kind()
            reader.SetFileName(str(self.run_folder / "run.xdmf"))
            reader.UpdateInformation()
            times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
            np.testing.assert_allclose(times, [group["time"][()] for group in self.groups], atol=1e-12)
            for time, group in zip(times, self.groups):
                reader.UpdateTimeStep(time)
                self.compare(reader.GetOutputDataObject(0), group)

    def test_the_tables_belong_to_the_frozen_particles(self):
        last = self.groups[-1]
        frozen = (last["phase"][...] == 0) & (last["freeze_time"][...] > 0)
        self.assertGreater(frozen.sum(), 20)
        with (self.run_folder / "exaca.csv").open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), ["x", "y", "z", "tm", "ts", "cr"])
        column = {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}
        spacing = self.file["spacing"][()]
        self.assertGreater(len(rows), 0.5 * frozen.sum())
        for key, field in (("ts", "freeze_time"), ("cr", "cooling_rate")):
            values = last[field][...][frozen]
            self.assertGreaterEqual(column[key].min(), values.min() * (1 - 1e-5))
            self.assertLessEqual(column[key].max(), values.max() * (1 + 1e-5))
        self.assertTrue((column["ts"] > column["tm"]).all())
        for axis in "xyz":
            self.assertLess(np.abs(column[axis] / spacing - np.round(column[axis] / spacing)).max(), 1e-6)

    def test_what_cannot_be_exported_is_refused_in_a_sentence(self):
        run = str(self.run_folder / "run.h5")
        for arguments, sentence in (
                ([run], "nothing to write: name at least one of --exaca"),
                (["README.md", "--xdmf"], "README.md is not an HDF5 file"),
                (["nowhere.h5", "--xdmf"], "nowhere.h5"),
                ([run, "--exaca", "x.csv", "--cell", "4 K"], "expected a quantity in m"),
                ([run, "--exaca", "x.csv", "--cell", "0 um"], "give a length above zero"),
                ([run, "--exaca", "x.csv", "--cell", "1 nm"], "would make a grid of over")):
            done = subprocess.run([BIN / "meltproof-export", *arguments], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn(sentence, done.stderr)
        self.assertFalse(Path("x.csv").exists())


if __name__ == "__main__":
    unittest.main()
