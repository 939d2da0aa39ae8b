// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/signal_unit.hpp"

#include <map>
#include <optional>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

struct Meaning {
  SignalQuantity quantity = SignalQuantity::counts;
  std::string unit;
  SignalScale scale;
};

std::optional<Meaning> meaning_of(const std::string& unit) {
  const Meaning count{SignalQuantity::counts, "count", {}};
  const Meaning kelvin{SignalQuantity::temperature, "K", {}};
  const Meaning celsius{SignalQuantity::temperature, "K", {1, 273.15F}};
  const Meaning fahrenheit{SignalQuantity::temperature, "K", {5.F / 9.F, 273.15F - 32 * 5.F / 9.F}};
  const Meaning radiance{SignalQuantity::radiance, "W m-2 sr-1", {}};
  static const std::map<std::string, Meaning> meanings = {{"count", count},
                                                          {"counts", count},
                                                          {"DL", count},
                                                          {"K", kelvin},
                                                          {"kelvin", kelvin},
                                                          {"degC", celsius},
                                                          {"C", celsius},
                                                          {"\xC2\xB0"
                                                           "C",
                                                           celsius},
                                                          {"celsius", celsius},
                                                          {"degF", fahrenheit},
                                                          {"W m-2 sr-1", radiance},
                                                          {"W/(m^2 sr)", radiance},
                                                          {"W/m^2/sr", radiance}};
  const auto found = meanings.find(unit);
  return found == meanings.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

void SignalScale::apply(std::vector<float>& values) const {
  if (factor == 1 && offset == 0) return;
  for (float& value : values) value = value * factor + offset;
}

SignalScale describe_signal(const std::string& in_file, const std::string& from_user,
                            RecordingHeader& header) {
  const auto meaning = meaning_of(from_user.empty() ? in_file : from_user);
  if (!from_user.empty() && !meaning)
    throw InputError(fmt::format(
        "{}: the unit \"{}\" was given for the values; expected count, K, degC or W m-2 sr-1.",
        header.path.string(), from_user));
  if (!meaning) {
    header.notes.push_back(
        in_file.empty()
            ? std::string("The file does not say what its values are, so they count as a bare "
                          "signal; give their unit if they are temperatures.")
            : fmt::format("The unit \"{}\" of the values is not known here, so they count as a "
                          "bare signal; give it as count, K or degC.",
                          in_file.substr(0, 40)));
    return {};
  }
  header.quantity = meaning->quantity;
  header.unit = meaning->unit;
  return meaning->scale;
}

}  // namespace meltproof::imaging
