// SPDX-License-Identifier: GPL-3.0-or-later
// Synthetic texts in the styles of FLIR's, InfraTec's and Optris's software.
#include "imaging/recording/csv.hpp"

#include <gtest/gtest.h>

#include "imaging/recording/csv_commas.hpp"
#include "imaging/recording/csv_row.hpp"
#include "imaging/recording/folder.hpp"
#include "imaging/recording/formats.hpp"
#include "imaging/recording/synthetic_files.hpp"
#include "imaging/recording/test_folder.hpp"

namespace meltproof::imaging {
namespace {

const std::vector<float> two_by_three = {20.1F, 20.2F, 20.3F, 21.1F, 21.2F, 21.3F};

std::vector<float> read(const TestFolder& folder, const std::string& text,
                        const ReadOptions& options = {}) {
  const auto recording = open_recording(folder.file("a.csv", text), options);
  EXPECT_EQ(recording.header().width, 3u) << text;
  EXPECT_EQ(recording.header().height, 2u) << text;
  return recording.frame(0).values;
}

TEST(Csv, FindsSeparatorAndDecimalSign) {
  const TestFolder folder;
  EXPECT_EQ(read(folder, "20.1,20.2,20.3\n21.1,21.2,21.3\n"), two_by_three);
  EXPECT_EQ(read(folder, "20,1;20,2;20,3\r\n21,1;21,2;21,3\r\n"), two_by_three);
  EXPECT_EQ(read(folder, "20,1\t20,2\t20,3\n21,1\t21,2\t21,3"), two_by_three);
  EXPECT_EQ(read(folder, "20.1  20.2 20.3 \n 21.1 21.2  21.3\n"), two_by_three);
  EXPECT_EQ(read(folder, "20.1, 20.2, 20.3,\n21.1, 21.2, 21.3,\n"), two_by_three);
  EXPECT_EQ(read(folder, "\"20,1\",\"20,2\",\"20,3\"\n\"21,1\",\"21,2\",\"21,3\"\n"), two_by_three);
  EXPECT_EQ(read(folder,
                 "\xEF\xBB\xBF"
                 "20.1;20.2;20.3\n21.1;21.2;21.3\n"),
            two_by_three);
  EXPECT_EQ(read(folder, "2.01e1;+20.2;20.3\n21.1;21.2;21.3\n"), two_by_three);
}

TEST(Csv, KeepsWhatTheUserSays) {
  const TestFolder folder;
  EXPECT_EQ(read(folder, "1|2|3\n20.1|20.2|20.3\n21.1|21.2|21.3\n",
                 {.separator = "|", .preamble_lines = 1}),
            two_by_three);
  const auto path = folder.file("b.csv", "1;2\n3;4\n");
  EXPECT_TRUE(says(refusal_of([&] { open_csv(path, {.decimal = "x"}); }), "decimal sign"));
  EXPECT_TRUE(says(refusal_of([&] { open_csv(path, {.unit = "mood"}); }), "mood"));
  EXPECT_FLOAT_EQ(open_csv(path, {.unit = "degC"}).frame(0).values[0], 274.15F);
}

TEST(Csv, AsksWhereACommaMayBeEither) {
  const TestFolder folder;
  // Three columns with a decimal comma, or six of whole numbers.
  const std::string text = "20,1,20,2,20,3\n21,1,21,2,21,3\n";
  const auto path = folder.file("a.csv", text);
  EXPECT_TRUE(says(refusal_of([&] { open_csv(path); }), "two values or four"));
  EXPECT_TRUE(says(refusal_of([&] { open_csv(path, {.separator = ","}); }), "decimal = \".\""));
  EXPECT_EQ(open_csv(path, {.decimal = "."}).header().width, 6u);
  // Split at both, the sentence of the user would be read as six whole numbers.
  EXPECT_TRUE(says(refusal_of([&] { open_csv(path, {.decimal = ","}); }), "in quotes"));
  EXPECT_TRUE(says(refusal_of([&] { open_csv(path, {.separator = ",", .decimal = ","}); }),
                   "semicolons or tabs"));
  EXPECT_TRUE(commas_look_decimal("3,2\n20,05,20,07\n"));
  for (const char* plain : {"20,21,22,23\n24,25,26,27\n", "007,008,009,010\n", "0,0,0,5,0,0\n",
                            "20.1,3,20.2,4\n", "20,1,20\n", "1,-5,1,-6\n", "3,2\n", ""})
    EXPECT_FALSE(commas_look_decimal(plain)) << plain;
}

TEST(Csv, ReadsWholeNumbersBetweenCommas) {
  const TestFolder folder;
  for (const std::size_t width : {4u, 5u, 40u})
    for (std::size_t i = 0; i < 20; ++i) {
      const auto picture = synthetic::scene(width, 12, i);
      std::string text;
      for (std::size_t k = 0; k < picture.counts.size(); ++k)
        text += std::to_string(picture.counts[k]) + ((k + 1) % width == 0 ? "\n" : ",");
      EXPECT_EQ(open_csv(folder.file("a.csv", text)).header().width, width);
    }
}

TEST(Csv, PassesOverAPreambleAndReadsTheUnitInIt) {
  const TestFolder folder;
  const std::string rows = "20,1;20,2;20,3\n21,1;21,2;21,3\n";
  const auto infratec =
      open_recording(folder.file("a.asc",
                                 "[Settings]\nVersion=2\nImageWidth=3\nImageHeight=2\nTempUnit=\xB0"
                                 "C\n[Data]\n" +
                                     rows));
  EXPECT_EQ(infratec.header().quantity, SignalQuantity::temperature);
  EXPECT_EQ(infratec.header().unit, "K");
  EXPECT_FLOAT_EQ(infratec.frame(0).values[0], 293.25F);
  const auto utf8 = open_csv(folder.file("b.csv",
                                         "Unit:;\xC2\xB0"
                                         "C\nSize;3;2\n3;2\n" +
                                             rows));
  EXPECT_EQ(utf8.header().frames, 1u);
  EXPECT_FLOAT_EQ(utf8.frame(0).values[5], 294.45F);
  const auto counts = open_csv(folder.file("c.csv",
                                           "Units: Counts\nAtmosphere: 20 \xC2\xB0"
                                           "C\n" +
                                               rows));
  EXPECT_EQ(counts.header().quantity, SignalQuantity::counts);
  const auto nothing = open_csv(folder.file("d.csv", rows));
  EXPECT_EQ(nothing.header().quantity, SignalQuantity::counts);
  EXPECT_TRUE(says(nothing.header().notes.back(), "does not say what its values are"));
  EXPECT_EQ(csv_unit("from 20 Celsius, that is 293 Kelvin"), "");
}

TEST(Csv, SeparatesFramesByBlankLinesAndByWords) {
  const TestFolder folder;
  const auto first = synthetic::scene(6, 4, 0), second = synthetic::scene(6, 4, 1);
  for (const std::string between :
       {"\n", "Frame 2\n", "\nFrame 2\nTime: 0.01 s\n\n", ";;;\n", "2;0.01\n"}) {
    const auto recording =
        open_csv(folder.file("a.csv", "A recording\n" + synthetic::csv(first, ';', '.') + between +
                                          synthetic::csv(second, ';', '.')));
    ASSERT_EQ(recording.header().frames, 2u) << between;
    const auto f = recording.frame(1);
    for (std::size_t i = 0; i < f.values.size(); ++i)
      ASSERT_FLOAT_EQ(f.values[i], static_cast<float>(second.counts[i]) / 100);
  }
}

TEST(Csv, DividesRowsWhereNothingSeparatesFrames) {
  const TestFolder folder;
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) text += synthetic::csv(synthetic::scene(6, 4, i), ',', '.');
  text += "1,2,3,4,5,6\n";
  const auto recording = open_csv(folder.file("a.csv", text), {.frame_rows = 4});
  ASSERT_EQ(recording.header().frames, 3u);
  EXPECT_EQ(recording.header().frames_lost, 1u);
  EXPECT_FLOAT_EQ(recording.frame(2).values[23],
                  static_cast<float>(synthetic::scene(6, 4, 2).counts[23]) / 100);
}

TEST(Csv, KeepsWholeFramesAndNamesTheLineThatInterrupts) {
  const TestFolder folder;
  const std::string frame = synthetic::csv(synthetic::scene(6, 4, 0), ';', '.');
  const std::string whole = frame + "\n" + frame + "\n" + frame;
  const auto cut = open_csv(folder.file("a.csv", whole.substr(0, whole.size() - 20)));
  EXPECT_EQ(cut.header().frames, 2u);
  EXPECT_EQ(cut.header().frames_lost, 1u);
  const auto torn = folder.file("b.csv", frame + "\n1;2;3;4;5;6\noops;\n" + frame + "\n" + frame);
  EXPECT_TRUE(says(refusal_of([&] { open_csv(torn); }), "line 6"));
  // No row is lost in silence: neither one with a word in it, nor those in front of it.
  for (const std::string& bad :
       {"1;2;x;4;5;6\n" + frame, frame + "1;2;x;4;5;6\n", "1;2;3;4;5;6\nFrame\n" + frame}) {
    const auto path = folder.file("c.csv", bad);
    EXPECT_TRUE(says(refusal_of([&] { open_csv(path); }), "repair")) << bad;
  }
  const auto word = folder.file("d.csv", frame + "1;2;x y;4;5;6\n");
  EXPECT_TRUE(says(refusal_of([&] { open_csv(word); }), "line 5, column 3: \"x y\""));
  // A value less or more, in the only frame, in the first and the last row of one, with its rows
  // counted; but the end of a file may be missing.
  const std::string rows = "1;2;3;4;5;6\n1;2;3;4;5;6\n";
  for (const std::string row : {"1;2;3;4;5\n", "1;2;3;4;5;6;7\n"}) {
    for (const std::string& bad :
         {rows + "1;2;3;4;5;6\n" + row + rows, frame + "\n" + row + "1;2;3;4;5;6\n" + rows,
          frame + "\n" + rows + "1;2;3;4;5;6\n" + row + "\n" + frame}) {
      const auto path = folder.file("e.csv", bad);
      EXPECT_TRUE(says(refusal_of([&] { open_csv(path); }), "where the rows beside it have 6"))
          << bad;
    }
    const auto counted = folder.file("f.csv", frame + rows + row + rows);
    EXPECT_TRUE(says(refusal_of([&] { open_csv(counted, {.frame_rows = 4}); }), "line 7 has"));
    const auto end = folder.file("g.csv", frame + "\n" + rows + row);
    EXPECT_EQ(open_csv(end).header().frames_lost, 1u);
  }
}

TEST(Csv, MarksMissingValuesAsDead) {
  const TestFolder folder;
  const auto f = open_csv(folder.file("a.csv", "1;;3\n4;NaN;---\n1;2;3\n")).frame(0);
  const auto d = PixelStatus::dead, g = PixelStatus::good;
  EXPECT_EQ(f.status, (std::vector{g, d, g, g, d, d, g, g, g}));
}

TEST(Csv, ReadsLinesLongerThanAnyBuffer) {
  const TestFolder folder;
  const auto picture = synthetic::scene(70000, 2, 0);
  const auto recording = open_csv(folder.file("a.csv", synthetic::csv(picture, ';', ',')));
  ASSERT_EQ(recording.header().width, 70000u);
  EXPECT_FLOAT_EQ(recording.frame(0).values.back(),
                  static_cast<float>(picture.counts.back()) / 100);
}

TEST(Csv, LeavesOutTheNamesInFrontOfRows) {
  const TestFolder folder;
  const std::string flir =
      "File:,FLIR0042.seq\n\nParameters:,Emissivity:,0.95\n,Refl. temp:,20.00 \xC2\xB0"
      "C\n,Distance:,1.00 m\n\nFrame 1,20.1,20.2,20.3\n,21.1,21.2,21.3\n\nFrame 2,30.1,30.2,30.3\n,"
      "31.1,31.2,31.3\n";
  const auto recording = open_recording(folder.file("a.csv", flir));
  ASSERT_EQ(recording.header().frames, 2u);
  ASSERT_EQ(recording.header().width, 3u);
  ASSERT_EQ(recording.header().height, 2u);
  EXPECT_EQ(recording.header().quantity, SignalQuantity::temperature);
  const auto celsius = [](float t) { return t + 273.15F; };
  EXPECT_FLOAT_EQ(recording.frame(0).values[0], celsius(20.1F));
  EXPECT_FLOAT_EQ(recording.frame(1).values[5], celsius(31.3F));
  std::string joined = flir;  // without a blank line between frames, and with semicolons
  joined.replace(joined.find("\n\nFrame 2"), 2, "\n");
  std::replace(joined.begin(), joined.end(), ',', ';');
  EXPECT_EQ(open_recording(folder.file("b.csv", joined)).header().frames, 2u);
  const auto named = open_recording(folder.file("c.csv", "row 1;1;2;3\nrow 2;4;5;6\n"));
  EXPECT_EQ(named.header().width, 3u);
  EXPECT_EQ(named.frame(0).values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
}

TEST(Csv, ReadsTextOfSixteenBitCharacters) {
  const TestFolder folder;
  const std::string text =
      "TempUnit=\xB0"
      "C\r\n20,1\t20,2\t20,3\r\n21,1\t21,2\t21,3\r\n";
  for (const bool big : {false, true}) {
    std::string wide = big ? "\xFE\xFF" : "\xFF\xFE";
    for (const char c : text) wide += big ? std::string{'\0', c} : std::string{c, '\0'};
    const auto recording = open_recording(folder.file("a.csv", wide));
    EXPECT_EQ(recording.header().format, "CSV");
    EXPECT_FLOAT_EQ(recording.frame(0).values[5], 294.45F);
  }
}

TEST(Csv, LeavesOutTheNumbersOfRowsAndColumns) {
  const TestFolder folder;
  const auto picture = synthetic::scene(6, 5, 0);
  const auto table = [&](bool row, bool column, int first, const std::string& corner) {
    std::string text;
    for (std::size_t y = row ? 0 : 1; y <= 5; ++y) {
      if (column) text += (y == 0 ? corner : std::to_string(static_cast<int>(y) - 1 + first)) + ",";
      for (std::size_t x = 0; x < 6; ++x)
        text += (y == 0 ? std::to_string(static_cast<int>(x) + first)
                        : std::to_string(picture.counts[(y - 1) * 6 + x]) + ".5") +
                (x == 5 ? "\n" : ",");
    }
    return text;
  };
  std::vector<float> expected;
  for (const auto count : picture.counts) expected.push_back(static_cast<float>(count) + 0.5F);
  for (const std::string& text :
       {table(true, true, 0, ""), table(true, true, 1, "0"), table(true, true, 0, "NaN"),
        table(true, false, 0, ""), table(false, true, 1, ""), table(false, false, 0, ""),
        table(true, true, 0, "") + "\n" + table(true, true, 0, "")}) {
    const auto recording = open_csv(folder.file("a.csv", text));
    ASSERT_EQ(recording.header().width, 6u) << text;
    ASSERT_EQ(recording.header().height, 5u) << text;
    EXPECT_EQ(recording.frame(recording.header().frames - 1).values, expected) << text;
  }
  // A ramp is a picture.
  EXPECT_EQ(open_csv(folder.file("b.csv", "0,1,2,3,4.0\n1,2,3,4,5.0\n")).header().height, 2u);
  EXPECT_EQ(open_csv(folder.file("c.csv", "0,1,2,3,4.0\n0,1,2,3,4.0\n")).header().height, 2u);
}

TEST(Folder, ReadsFilesInTheOrderOfTheirNumbers) {
  const TestFolder folder;
  for (const std::size_t i : {10u, 2u, 1u})
    folder.file("frame_" + std::to_string(i) + ".csv",
                synthetic::csv(synthetic::scene(6, 4, i), ';', ','));
  const auto recording = open_recording(folder.path());
  ASSERT_EQ(recording.header().frames, 3u);
  EXPECT_EQ(recording.header().companions.size(), 3u);
  EXPECT_EQ(recording.header().sha256.size(), 64u);
  for (const std::size_t i : {2u, 0u, 1u}) {
    const std::size_t number = i == 2 ? 10 : i + 1;
    EXPECT_FLOAT_EQ(recording.frame(i).values[9],
                    static_cast<float>(synthetic::scene(6, 4, number).counts[9]) / 100);
    EXPECT_EQ(recording.frame(i).index, i);
  }
  folder.file("frame_3.csv", "1;2\n3;4\n");
  EXPECT_TRUE(says(refusal_of([&] { open_recording(folder.path()); }), "frame_3.csv"));
  folder.file("frame_3.irb", "");
  EXPECT_TRUE(says(refusal_of([&] { open_recording(folder.path()); }), ".csv and .irb"));
  EXPECT_TRUE(natural_order("a9b10", "a09b11"));
  EXPECT_FALSE(natural_order("a10", "a9"));
}

TEST(Folder, SaysThatItIsEmpty) {
  const TestFolder folder;
  EXPECT_TRUE(says(refusal_of([&] { open_recording(folder.path()); }), "holds no file"));
}

}  // namespace
}  // namespace meltproof::imaging
