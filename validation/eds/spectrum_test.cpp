// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/spectrum.hpp"

#include <cmath>
#include <numeric>

#include "validation/eds/eds_test_files.hpp"
#include "validation/eds/elements.hpp"
#include "validation/eds/formats.hpp"
#include "validation/eds/msa.hpp"
#include "validation/eds/spx.hpp"

namespace meltproof::validation {
namespace {

double sum(const Spectrum& s) { return std::accumulate(s.counts.begin(), s.counts.end(), 0.0); }

// Pure iron at 20 kV; the numbers are those of samples/README.md.
TEST(Msa, ReadsAVendorsSpectrumOfIron) {
  const auto path = vendor_file("nexl_Fe_std.msa");
  if (!std::filesystem::exists(path)) {
    GTEST_SKIP() << "the vendors' sample files are not beside this checkout";
  }
  const Spectrum iron = *read_eds_export(path).spectrum;
  ASSERT_EQ(iron.counts.size(), 4096u);
  EXPECT_DOUBLE_EQ(iron.channel_width, 5.00258e-3);
  EXPECT_DOUBLE_EQ(iron.first_energy, -0.483028);
  EXPECT_EQ(sum(iron), 4589157);  // lines end in a comma
  EXPECT_EQ(*iron.voltage, 20);
  EXPECT_EQ(*iron.livetime, 100);
  EXPECT_EQ(counts_between(iron, 6.3038, 6.5038), 1345735);  // K-alpha within 100 eV
  double most = 0, net_iron = 0;
  for (const auto& window : window_counts(iron)) {
    if (window.element == "Fe") {
      EXPECT_EQ(window.gross, 1345735);
      EXPECT_NEAR(window.noise, std::sqrt(window.net + 2 * window.background), 1e-9);
      net_iron = window.net;
    } else {
      most = std::max(most, window.net);
    }
  }
  EXPECT_GT(net_iron, 1.2e6);
  // The strobe peak at 0 eV (86599 counts in one channel) enters no window.
  EXPECT_LT(most, 0.01 * net_iron);
  EXPECT_REFUSED(read_line_scan(path), "holds a spectrum, not a composition");
}

// CuFeS2; fractions as the vendor's program reports them, which add to 0.950.
TEST(Spx, ReadsAVendorsQuantification) {
  const auto path = vendor_file("bruker_nano.spx");
  if (!std::filesystem::exists(path)) {
    GTEST_SKIP() << "the vendors' sample files are not beside this checkout";
  }
  const auto found = read_spx(path);
  EXPECT_EQ(found.spectrum.counts.size(), 4096u);
  EXPECT_EQ(sum(found.spectrum), 76293);
  EXPECT_EQ(*found.spectrum.voltage, 15);
  ASSERT_TRUE(found.composition);
  const auto& mass = found.composition->mass;
  ASSERT_EQ(mass.size(), 3u);
  EXPECT_NEAR(mass.at("S"), 0.2637949, 5e-8);
  EXPECT_NEAR(mass.at("Fe"), 0.3066824, 5e-8);
  EXPECT_NEAR(mass.at("Cu"), 0.3799997, 5e-8);
  for (const auto& [symbol, value] : atom_from_mass(mass)) {
    EXPECT_NEAR(value, found.composition->atom.at(symbol), 5e-5) << symbol;
  }
  EXPECT_NEAR(found.composition->atom.at("Cu"), 0.3035796, 5e-8);
  EXPECT_NEAR(found.composition->counts.at("Fe"), 4510.390669, 1e-6);
  EXPECT_EQ(found.composition->background.at("Fe"), 25);
  const LineScan point = read_line_scan(path);
  EXPECT_EQ(point.position, std::vector<double>{0});
  EXPECT_NEAR(point.total[0], 0.950477, 1e-6);  // as reported, not normalised
  for (const auto& window : window_counts(found.spectrum)) {
    if (window.element == "S" || window.element == "Cu" || window.element == "Fe") {
      EXPECT_GT(window.net, 20 * window.noise) << window.element;
    }
  }
}

const std::string header =
    "#FORMAT      : EMSA/MAS Spectral Data File\n#VERSION     : 1.0\n#TITLE : synthetic\n"
    "#NPOINTS     : 4\n#XUNITS      : eV\n#BEAMKV   -kV: 30\n#XPERCHAN    : 10\n"
    "#OFFSET      : -10\n";

Spectrum msa(const std::string& text) { return read_msa(synthetic_file("spectrum.msa", text)); }

TEST(Msa, CountsMayStandInRowsOrInPairsWithEnergies) {
  const auto rows = msa(header + "#DATATYPE : Y\n#SPECTRUM : \n1, 2, 3,\n4\n#ENDOFDATA : \n");
  EXPECT_EQ(rows.counts, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_NEAR(rows.energy(3), 0.02, 1e-15);
  EXPECT_EQ(*rows.voltage, 30);
  const auto pairs = msa(header +
                         "#DATATYPE : XY\n#SPECTRUM : \n-10, 1\n0, 2\n10, 3\n20, 4\n"
                         "#ENDOFDATA : \n");
  EXPECT_EQ(pairs.counts, rows.counts);
  EXPECT_NEAR(pairs.energy(3), 0.02, 1e-15);
}

TEST(Msa, ALineOfIntensitiesIsKnownAndNotTakenForAComposition) {
  auto text = header + "#DATATYPE : Y\n#SPECTRUM : \n1,2,3,4\n#ENDOFDATA : \n";
  text.replace(text.find("eV\n"), 3, "um\n");
  EXPECT_TRUE(msa(text).along_a_line);
  EXPECT_TRUE(window_counts(msa(text)).empty());
  EXPECT_REFUSED(read_line_scan(synthetic_file("line.msa", text)), "intensities along a line");
}

TEST(Msa, EveryFaultIsASentence) {
  const std::string y = "#DATATYPE : Y\n#SPECTRUM : \n";
  EXPECT_REFUSED(msa(header + y + "1,2,3,4\n"), "without #ENDOFDATA after 4 values");
  EXPECT_REFUSED(msa(header), "ends before #SPECTRUM");
  EXPECT_REFUSED(msa(header + y + "1,2,3\n#ENDOFDATA : \n"), "announces 4 channels and 3 values");
  EXPECT_REFUSED(msa(header + y + "1,2,x,4\n#ENDOFDATA : \n"), ":11: \"x\" is no number");
  EXPECT_REFUSED(msa(header + "#DATATYPE : Z\n#SPECTRUM : \n#ENDOFDATA : \n"),
                 "#DATATYPE is \"Z\"");
  EXPECT_REFUSED(msa(header + "#DATATYPE : XY\n#SPECTRUM : \n0,1 1,2 2,3 9,4\n#ENDOFDATA : \n"),
                 "not evenly spaced");
  EXPECT_REFUSED(msa("#FORMAT : EMSA/MAS\nloose\n"), ":2: \"loose\"");
  auto text = header + y + "1,2,3,4\n#ENDOFDATA : \n";
  text.replace(text.find("#OFFSET"), 7, "#OFFSEX");
  EXPECT_REFUSED(msa(text), "#OFFSET is missing");
}

/// A spectrum of four channels with a quantification of Al and Fe, written by hand.
std::string spx(const std::string& result, const std::string& count = "4") {
  return "<?xml version=\"1.0\"?>\n<TRTSpectrum>\n<ClassInstance Type=\"TRTSpectrum\" "
         "Name=\"synthetic\">\n<ClassInstance Type=\"TRTSpectrumHeader\"><ChannelCount>" +
         count +
         "</ChannelCount><CalibAbs>-0.1</CalibAbs><CalibLin>0.01</CalibLin></ClassInstance>\n"
         "<Channels>1,2,3,4</Channels>\n" +
         result + "</ClassInstance>\n</TRTSpectrum>\n";
}
std::string result(int atom, const std::string& mass) {
  return "<Result><Atom>" + std::to_string(atom) + "</Atom><MassPercent>" + mass +
         "</MassPercent><NetIntens>100</NetIntens><Background>10</Background></Result>\n";
}
std::string results(const std::string& aluminium, const std::string& iron) {
  return "<ClassInstance Type=\"TRTResult\">" + result(13, aluminium) + result(26, iron) +
         "</ClassInstance>\n";
}

TEST(Spx, PercentAndFractionsAreToldApartByTheirSum) {
  const auto of = [](const std::string& text) {
    return read_spx(synthetic_file("one.spx", text)).composition->mass.at("Al");
  };
  EXPECT_DOUBLE_EQ(of(spx(results("2.0E-1", "0.79"))), 0.2);
  EXPECT_DOUBLE_EQ(of(spx(results("20", "79"))), 0.2);
}

TEST(Spx, EveryFaultIsASentence) {
  const auto read = [](const std::string& text) { read_spx(synthetic_file("bad.spx", text)); };
  const std::string whole = spx(results("0.2", "0.79"));
  EXPECT_REFUSED(read(whole.substr(0, whole.size() - 60)), "damaged or cut off");
  EXPECT_REFUSED(read(spx("", "5")), "announces 5 channels and 4");
  EXPECT_REFUSED(read(spx(results("x", "0.79"))), "<MassPercent> is \"x\"");
  EXPECT_REFUSED(
      read(spx("<ClassInstance Type=\"TRTResult\">" + result(119, "1") + "</ClassInstance>")),
      "number 119");
  EXPECT_REFUSED(read("<TRTSpectrum></TRTSpectrum>"), "holds no spectrum");
  EXPECT_REFUSED(read_line_scan(synthetic_file("plain.spx", spx(""))),
                 "holds a spectrum, not a composition");
}

TEST(PointsOfALine, AFolderOrAListOfSpectra) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "synthetic_points";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "p10.spx") << spx(results("0.3", "0.7"));
  std::ofstream(folder / "p9.spx") << spx(results("0.2", "0.79"));
  std::ofstream(folder / "notes.txt") << "not a spectrum";
  EXPECT_REFUSED(read_line_scan(folder), "--point-spacing");
  ScanOptions options;
  options.point_spacing = 0.5e-6;
  const LineScan line = read_line_scan(folder, options);
  EXPECT_EQ(line.position, (std::vector<double>{0, 0.5e-6}));
  EXPECT_EQ(line.elements.at("Al").fraction, (std::vector<double>{0.2, 0.3}));  // 9 before 10
  EXPECT_EQ(line.elements.at("Fe").background, (std::vector<double>{10, 10}));
  const auto list = [&](const std::string& text) {
    std::ofstream(folder / "list.csv") << text;
    return read_line_scan(folder / "list.csv");
  };
  const LineScan listed = list("# synthetic\nfile,position [um]\np10.spx,1\np9.spx,3.5\n");
  EXPECT_NEAR(listed.position[1], 3.5e-6, 1e-18);
  EXPECT_EQ(listed.elements.at("Al").fraction, (std::vector<double>{0.3, 0.2}));
  EXPECT_REFUSED(list("file,position\np9.spx,1\n"), "has no unit");
  EXPECT_REFUSED(list("file,position [um]\np9.spx,3\np10.spx,1\n"), "order of the line");
  EXPECT_REFUSED(list("file,position [um]\np8.spx,3\n"), "p8.spx");
  EXPECT_REFUSED(list("file,position [um]\np9.spx;3\n"), ":2: \"p9.spx;3\"");
}

TEST(Formats, AreKnownByTheirContentNotTheirName) {
  EXPECT_EQ(read_eds_export(synthetic_file("named.csv", spx(results("0.2", "0.8")))).format,
            "Bruker SPX");
  EXPECT_REFUSED(read_eds_export(synthetic_file("empty.csv", "")), "the file is empty");
  EXPECT_REFUSED(read_eds_export(synthetic_file("odd.csv", std::string("\1\0\2", 3))),
                 "of an unknown kind");
  EXPECT_REFUSED(read_eds_export("nowhere.spx"), "no such file");
  EXPECT_REFUSED(read_eds_export(synthetic_file("map.tif", std::string("II*\0", 4))),
                 "neither its element nor its scale");
}

TEST(Elements, ThePeriodicTableIsInOrder) {
  for (std::size_t i = 1; i < elements().size(); ++i) {
    EXPECT_LT(elements()[i - 1].number, elements()[i].number);
    EXPECT_EQ(element_of_number(elements()[i].number), &elements()[i]);
  }
  // An edge lies above its line, and both rise with the number.
  EXPECT_LT(*element("Al").k_alpha, *element("Al").k_edge);
  EXPECT_LT(*element("Al").k_edge, *element("Si").k_alpha);
  EXPECT_EQ(element_named_in("AlK (wt%)"), "Al");
  EXPECT_EQ(element_named_in("Fe-Ka1 norm."), "Fe");
  EXPECT_EQ(element_named_in("distance in um"), "");
}

}  // namespace
}  // namespace meltproof::validation
