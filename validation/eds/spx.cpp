// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/spx.hpp"

#include <cmath>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "validation/csv.hpp"
#include "validation/eds/elements.hpp"

namespace meltproof::validation {
namespace {

/// The number in a child of `node`, or of one of its children; nothing if there is none.
std::optional<double> number(const pugi::xml_node& node, const char* name,
                             const std::string& place) {
  const std::string text = trimmed(node.child(name).text().get());
  if (text.empty()) {
    return std::nullopt;
  }
  const auto value = number_of(text);
  if (!value || !std::isfinite(*value)) {
    throw InputError(fmt::format("{}: <{}> is \"{}\": expected a number.", place, name, text));
  }
  return value;
}

double required(const pugi::xml_node& node, const char* name, const std::string& place) {
  const auto value = number(node, name, place);
  if (!value) {
    throw InputError(
        fmt::format("{}: <{}> is missing in <{} Type=\"{}\">: save the spectrum again in Esprit.",
                    place, name, node.name(), node.attribute("Type").value()));
  }
  return *value;
}

pugi::xml_node instance(const pugi::xml_node& root, const char* type) {
  return root.find_node([type](const pugi::xml_node& node) {
    return std::string_view(node.name()) == "ClassInstance" &&
           std::string_view(node.attribute("Type").value()) == type;
  });
}

std::vector<double> channels(const pugi::xml_node& spectrum, const std::string& place) {
  std::vector<double> counts;
  for (const auto& cell : split_cells(spectrum.child("Channels").text().get(), ',')) {
    const auto value = number_of(cell);
    if (!value || !std::isfinite(*value)) {
      throw InputError(fmt::format("{}: <Channels> holds \"{}\" as count {}: expected a number.",
                                   place, cell.substr(0, 40), counts.size()));
    }
    counts.push_back(*value);
  }
  return counts;
}

PointComposition composition(const pugi::xml_node& results, const std::string& place) {
  PointComposition point;
  double sum = 0;
  for (const auto& result : results.children("Result")) {
    const double atom = required(result, "Atom", place);
    const Element* found =
        atom >= 1 && atom <= 120 ? element_of_number(static_cast<int>(atom)) : nullptr;
    if (found == nullptr) {
      throw InputError(fmt::format(
          "{}: a result is of the element with number {}, which is not known here.", place, atom));
    }
    point.mass[found->symbol] = required(result, "MassPercent", place);
    sum += point.mass[found->symbol];
    if (const auto share = number(result, "AtomPercent", place)) {
      point.atom[found->symbol] = *share;
    }
    const auto net = number(result, "NetIntens", place);
    const auto background = number(result, "Background", place);
    if (net && background) {
      point.counts[found->symbol] = *net;
      point.background[found->symbol] = *background;
    }
  }
  if (sum > 2) {
    for (auto* fractions : {&point.mass, &point.atom}) {
      for (auto& [symbol, value] : *fractions) {
        value /= 100;
      }
    }
  }
  return point;
}

}  // namespace

bool is_spx(std::string_view first_bytes) {
  return first_bytes.find("<TRTSpectrum") != std::string_view::npos;
}

SpxContent read_spx(const std::filesystem::path& path) {
  const std::string place = path.string(), text = read_file(path);
  pugi::xml_document document;
  const auto parsed = document.load_buffer(text.data(), text.size());
  if (!parsed) {
    throw InputError(fmt::format("{}: the XML is damaged or cut off at byte {} of {} ({}).", place,
                                 parsed.offset, text.size(), parsed.description()));
  }
  const auto root = instance(document, "TRTSpectrum");
  const auto header = instance(root, "TRTSpectrumHeader");
  if (!root.child("Channels") || !header) {
    throw InputError(fmt::format(
        "{}: it holds no spectrum (<Channels> and TRTSpectrumHeader were expected).", place));
  }
  SpxContent content;
  content.spectrum.path = path;
  content.spectrum.title = root.attribute("Name").value();
  content.spectrum.counts = channels(root, place);
  content.spectrum.first_energy = required(header, "CalibAbs", place);
  content.spectrum.channel_width = required(header, "CalibLin", place);
  const double announced = required(header, "ChannelCount", place);
  if (announced != static_cast<double>(content.spectrum.counts.size()) ||
      !(content.spectrum.channel_width > 0)) {
    throw InputError(fmt::format("{}: <ChannelCount> announces {} channels and {} are there.",
                                 place, announced, content.spectrum.counts.size()));
  }
  content.spectrum.voltage = number(instance(root, "TRTESMAHeader"), "PrimaryEnergy", place);
  if (const auto time = number(instance(root, "TRTSpectrumHardwareHeader"), "LifeTime", place)) {
    content.spectrum.livetime = 1e-3 * *time;
  }
  if (const auto results = instance(root, "TRTResult"); results.child("Result")) {
    content.composition = composition(results, place);
    content.composition->voltage = content.spectrum.voltage;
  }
  return content;
}

}  // namespace meltproof::validation
