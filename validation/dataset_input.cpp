// SPDX-License-Identifier: GPL-3.0-or-later
// What dataset.toml may say.
#include "validation/dataset.hpp"

namespace meltproof::validation {
namespace {

InputTable column_table(DataColumn& column) {
  InputTable table("column", "One column of the CSV file.");
  table.text(column.name, {.name = "name", .about = "As in the CSV header.", .required = true})
      .text(column.unit, {.name = "unit",
                          .about = "As in the CSV header; 1 for pure numbers, text for labels.",
                          .required = true})
      .text(column.about, {.name = "about", .about = "What the numbers are.", .required = true})
      .text(column.uncertainty,
            {.name = "uncertainty", .about = "Name of the column with the uncertainty."})
      .text(column.uncertainty_kind,
            {.name = "uncertainty_kind", .about = "What the published uncertainty is."})
      .quantity(column.relative_uncertainty,
                {.name = "relative_uncertainty",
                 .unit = "1",
                 .about = "Standard uncertainty as a share of the value, for every row.",
                 .minimum = 0,
                 .maximum = 1});
  return table;
}

InputTable file_table(DataFile& file) {
  InputTable table("file", "One CSV file of the campaign.");
  table.text(file.name, {.name = "name", .about = "In the campaign's folder.", .required = true})
      .text(file.sha256, {.name = "sha256", .about = "SHA-256 of its bytes.", .required = true})
      .text(file.obtained, {.name = "obtained",
                            .about = "measured: the authors' numbers; digitised: read off a "
                                     "figure; pending: an empty slot.",
                            .required = true,
                            .choices = {"measured", "digitised", "pending"}})
      .text(file.source, {.name = "source", .about = "Publication, if the campaign has several."})
      .text(file.about, {.name = "about", .about = "What the file holds.", .required = true})
      .tables(
          "column", "The columns, in the order of the file.",
          [&file](std::size_t) { return column_table(file.columns.emplace_back()); }, true);
  return table;
}

}  // namespace

Input campaign_input(Campaign& campaign) {
  InputTable root("A campaign of measurements", "dataset.toml in a folder of data/experiments.");
  root.text(campaign.title, {.name = "title", .about = "What was measured.", .required = true})
      .texts(campaign.authors,
             {.name = "authors", .about = "Of the publication.", .required = true})
      .text(campaign.doi, {.name = "doi", .about = "Of the publication or data.", .required = true})
      .text(campaign.licence, {.name = "licence", .about = "Of the numbers.", .required = true})
      .text(campaign.about, {.name = "about", .about = "Set-up in a sentence.", .required = true})
      .tables(
          "file", "The CSV files.",
          [&campaign](std::size_t) { return file_table(campaign.files.emplace_back()); }, true);
  return Input(std::move(root));
}

}  // namespace meltproof::validation
