// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-export: a run in the forms that other programs read.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/atomic_file.hpp"
#include "base/program.hpp"
#include "base/units.hpp"
#include "solver/output/paraview.hpp"
#include "solver/output/solidification_csv.hpp"

int main(int argc, char** argv) {
  using namespace meltproof;
  Program program(
      "meltproof-export",
      "Writes a run in the forms that other programs read.\n"
      "\n"
      "  ParaView opens run.xdmf, which meltproof-solve writes beside run.h5, as it is; use --vtu "
      "for\n"
      "  programs without XDMF (VTK of Debian, PyVista, meshio): then open the .pvd file.\n"
      "  ExaCA takes the file of --exaca as its temperature data: x,y,z,tm,ts,cr in m, s, K/s, "
      "one\n"
      "  line per place of a grid whose cell (--cell) must be the cell size of the ExaCA input.\n"
      "  Solidification maps take the file of --gradient: x,y,z,ts,cr,g,v with the temperature\n"
      "  gradient g in K/m and the velocity v = cr/g of the liquidus in m/s.\n"
      "\n"
      "Both tables hold only places whose metal melted and froze again; values are fitted to the\n"
      "particles within two spacings. Places are those of freezing; tm is when the material that\n"
      "froze there melted last.\n"
      "\n"
      "Example: meltproof-export run/run.h5 --exaca time-temperature.csv --cell \"2.5 um\"\n"
      "         meltproof-export run/run.h5 --vtu run/vtu");
  std::string run, exaca, gradient, vtu, cell;
  bool xdmf = false;
  program.app.add_option("run", run, "run.h5 of meltproof-solve")->required();
  program.app.add_option("--exaca", exaca, "table x,y,z,tm,ts,cr to write");
  program.app.add_option("--gradient", gradient, "table x,y,z,ts,cr,g,v to write");
  program.app.add_option("--cell", cell,
                         "cell of the tables' grid, a length with its unit; default: the run's "
                         "particle spacing");
  program.app.add_option("--vtu", vtu,
                         "folder for one .vtu file per snapshot and a .pvd with times");
  program.app.add_flag("--xdmf", xdmf, "write the .xdmf beside the run again");
  return program.run(argc, argv, [&] {
    if (exaca.empty() && gradient.empty() && vtu.empty() && !xdmf) {
      throw InputError(
          "nothing to write: name at least one of --exaca FILE, --gradient FILE, --vtu FOLDER or "
          "--xdmf");
    }
    const bool tables = !exaca.empty() || !gradient.empty();
    std::vector<solver::FrozenPoint> points;
    if (tables) {
      const solver::FrozenTrack track = solver::read_frozen_track(run);
      double size = track.particles.spacing;
      if (!cell.empty()) {
        try {
          size = parse_quantity(cell, "m");
        } catch (const InputError& problem) {
          throw InputError(fmt::format("--cell: {}", problem.what()));
        }
      }
      points = solver::interpolate(track, size);
      if (track.still_liquid > 0) {
        spdlog::warn(
            "{} particles are still liquid at the last snapshot ({:.0f} us) and not in the tables; "
            "a longer output.cooling_limit lets them freeze",
            track.still_liquid, 1e6 * track.time);
      }
      if (points.empty()) {
        spdlog::warn("{}: nothing has melted and frozen again in {} particles; no table is written",
                     run, track.particles.size());
        return ExitStatus::no_result;
      }
      spdlog::info("{} frozen particles give {} places, {:.3g} um apart", track.frozen,
                   points.size(), 1e6 * size);
    }
    if (!exaca.empty()) {
      write_file(exaca, solver::exaca_csv(points));
    }
    if (!gradient.empty()) {
      write_file(gradient, solver::gradient_csv(points));
    }
    if (!vtu.empty()) {
      const auto written = solver::write_vtu(run, vtu);
      spdlog::info("{} snapshots; open {}", written.size() - 1, written.back().string());
    }
    if (xdmf) {
      spdlog::info("open {}", solver::write_xdmf(run).string());
    }
    return ExitStatus::success;
  });
}
