// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/paraview.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "base/artifact.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "solver/output/snapshot.hpp"

namespace meltproof::solver {
namespace {

/// What the two formats call a number type.
struct TypeName {
  const char* xdmf;
  int bytes;
  const char* vtk;
};

TypeName name_of(FieldType type) {
  switch (type) {
    case FieldType::float32:
      return {"Float", 4, "Float32"};
    case FieldType::float64:
      return {"Float", 8, "Float64"};
    case FieldType::int32:
      return {"Int", 4, "Int32"};
    case FieldType::int64:
      return {"Int", 8, "Int64"};
    case FieldType::uint8:
      break;
  }
  return {"UChar", 1, "UInt8"};
}

/// "temperature [K]"; numbers without a unit by their name alone.
std::string label(const SnapshotField& field) {
  return std::string(field.units) == "1" ? field.name
                                         : fmt::format("{} [{}]", field.name, field.units);
}

/// The groups of a run's snapshots, by number.
std::vector<std::string> snapshots_of(const ArtifactReader& run) {
  std::vector<std::string> names;
  if (run.has("snapshots")) {
    names = run.names("snapshots");
  }
  if (names.empty()) {
    throw InputError(
        fmt::format("{} holds no snapshots: there is nothing to show; take the run.h5 "
                    "that meltproof-solve wrote",
                    run.path().string()));
  }
  std::sort(names.begin(), names.end());
  for (auto& name : names) {
    name.insert(0, "snapshots/");
  }
  return names;
}

std::string item(const std::string& file, const std::string& path, const SnapshotField& field,
                 std::size_t count) {
  const TypeName type = name_of(field.type);
  return fmt::format(
      R"(<DataItem Format="HDF" NumberType="{}" Precision="{}" Dimensions="{}{}">{}:/{}</DataItem>)",
      type.xdmf, type.bytes, count, field.components == 3 ? " 3" : "", file, path);
}

/// A .vtu file as it grows: the XML head refers by offset into the binary blocks behind it.
class VtuFile {
 public:
  explicit VtuFile(std::size_t points) : points_(points) {}

  /// One array of the open section. @param components 0 leaves the attribute out.
  template <class T>
  void array(const std::string& name, const char* type, std::size_t components,
             const std::vector<T>& values) {
    head_ += fmt::format(
        R"(        <DataArray type="{}" Name="{}"{} format="appended" offset="{}"/>)", type, name,
        components > 1 ? fmt::format(R"( NumberOfComponents="{}")", components) : "", data_.size());
    head_ += "\n";
    const std::uint64_t bytes = values.size() * sizeof(T);
    append(&bytes, sizeof bytes);
    append(values.data(), bytes);
  }
  void open(const std::string& section) { head_ += fmt::format("      <{}>\n", section); }
  void close(const std::string& section) { head_ += fmt::format("      </{}>\n", section); }

  std::string text() const {
    return fmt::format(
               "<?xml version=\"1.0\"?>\n"
               "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
               "header_type=\"UInt64\">\n"
               "  <UnstructuredGrid>\n"
               "    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"1\">\n{}"
               "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_",
               points_, head_) +
           data_ + "\n  </AppendedData>\n</VTKFile>\n";
  }

 private:
  void append(const void* from, std::size_t bytes) {
    const std::size_t at = data_.size();
    data_.resize(at + bytes);
    if (bytes > 0) {
      std::memcpy(data_.data() + at, from, bytes);
    }
  }

  std::size_t points_;
  std::string head_, data_;
};

void add_array(VtuFile& vtu, const ArtifactReader& run, const std::string& path,
               const SnapshotField& field, const std::string& name) {
  const auto add = [&]<class T>(T) {
    vtu.array(name, name_of(field.type).vtk, field.components, run.read<T>(path).values);
  };
  switch (field.type) {
    case FieldType::float32:
      return add(float{});
    case FieldType::float64:
      return add(double{});
    case FieldType::int32:
      return add(std::int32_t{});
    case FieldType::int64:
      return add(std::int64_t{});
    case FieldType::uint8:
      return add(std::uint8_t{});
  }
}

std::string vtu(const ArtifactReader& run, const std::string& group) {
  const auto fields = snapshot_fields();
  const std::size_t count = run.shape(group + "/identity")[0];
  VtuFile file(count);
  file.open("Points");
  add_array(file, run, group + "/position", fields[0], "position [m]");
  file.close("Points");
  // All points in one cell: cells cost memory, and without any nothing would be drawn.
  std::vector<std::int64_t> connectivity(count);
  for (std::size_t i = 0; i < count; ++i) {
    connectivity[i] = static_cast<std::int64_t>(i);
  }
  constexpr std::uint8_t poly_vertex = 2;
  file.open("Cells");
  file.array("connectivity", "Int64", 1, connectivity);
  file.array("offsets", "Int64", 1, std::vector<std::int64_t>{static_cast<std::int64_t>(count)});
  file.array("types", "UInt8", 1, std::vector<std::uint8_t>{poly_vertex});
  file.close("Cells");
  file.open("PointData");
  for (const auto& field : fields.subspan(1)) {
    if (run.has(group + "/" + field.name)) {
      add_array(file, run, group + "/" + field.name, field, label(field));
    }
  }
  file.close("PointData");
  return file.text();
}

}  // namespace

std::string xdmf(const std::filesystem::path& path) {
  const ArtifactReader run(path, "meltproof run");
  const std::string file = path.filename().string();
  std::string out =
      "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n"
      "<Xdmf Version=\"3.0\">\n  <Domain>\n"
      "    <Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  const auto fields = snapshot_fields();
  for (const auto& group : snapshots_of(run)) {
    const std::size_t count = run.shape(group + "/identity")[0];
    // Readers draw what has cells: one per point, numbered by the identities, which are 0, 1, 2,
    // ... in a run of the suite.
    const std::string identity = group + "/identity";
    const bool numbered = run.read_slab<std::int64_t>(identity, count - 1, 1)[0] ==
                          static_cast<std::int64_t>(count) - 1;
    out += fmt::format(
        "      <Grid Name=\"metal\" GridType=\"Uniform\">\n"
        "        <Time Value=\"{}\"/>\n"
        "        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" "
        "NodesPerElement=\"1\">{}</Topology>\n"
        "        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
        run.scalar(group + "/time"), count, numbered ? item(file, identity, fields[1], count) : "",
        item(file, group + "/position", fields[0], count));
    for (const auto& field : fields.subspan(1)) {
      const std::string name = group + "/" + field.name;
      if (run.has(name)) {
        out += fmt::format(
            "        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n",
            label(field), field.components == 3 ? "Vector" : "Scalar",
            item(file, name, field, count));
      }
    }
    out += "      </Grid>\n";
  }
  return out + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

std::filesystem::path write_xdmf(const std::filesystem::path& run) {
  auto place = run;
  place.replace_extension(".xdmf");
  write_file(place, xdmf(run));
  return place;
}

std::vector<std::filesystem::path> write_vtu(const std::filesystem::path& path,
                                             const std::filesystem::path& folder) {
  const ArtifactReader run(path, "meltproof run");
  std::string list =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  std::vector<std::filesystem::path> written;
  for (const auto& group : snapshots_of(run)) {
    const std::string name = group.substr(group.find('/') + 1) + ".vtu";
    write_file(folder / name, vtu(run, group));
    list += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n",
                        run.scalar(group + "/time"), name);
    written.push_back(folder / name);
  }
  written.push_back(folder / (path.stem().string() + ".pvd"));
  write_file(written.back(), list + "  </Collection>\n</VTKFile>\n");
  return written;
}

}  // namespace meltproof::solver
