// How far the lobe by a table is from the lobe: the published figures, what our tables reach, and
// that docs/lut.md states what is so: the maximum over all angles, in units of the peak.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "bench/table_accuracy_study.h"

namespace gonio::tests {
namespace {

using lut::Coordinate;
using lut::Filter;
using lut::Storage;
using lut::Table;
using lut::TableKind;
using lut::Weights;

double error_of(TableKind kind, Coordinate coordinate, Storage storage, double alpha,
                bool reaches_lobe, Weights weights = Weights::exact) {
  return bench::worst_ward_error(
      bench::ward_table_of_512(kind, coordinate, storage, alpha, reaches_lobe), alpha,
      Filter::linear, weights);
}

double error_of_exponent(Coordinate coordinate, double alpha, bool reaches_lobe,
                         Weights weights = Weights::exact) {
  return error_of(TableKind::ward_exponent, coordinate, Storage::r32f, alpha, reaches_lobe,
                  weights);
}

struct Figure {
  double alpha, error, half_digit;
};

// Computed for this project's science page from the published table's description, by a program
// that shares nothing with this one.
TEST(LutAccuracy, TheListingLosesWhatIsKnownOfIt) {
  constexpr std::array<Figure, 6> known{{{0.05, 0.957, 5e-4},
                                         {0.1, 0.544, 5e-4},
                                         {0.2, 0.178, 5e-4},
                                         {0.4, 0.048, 5e-4},
                                         {0.6, 0.022, 5e-4},
                                         {1.0, 0.0078, 5e-5}}};
  for (const Figure& f : known) {
    EXPECT_NEAR(error_of_exponent(Coordinate::listing, f.alpha, false), f.error, f.half_digit);
  }
}

// The same source, row 3: the first and the last texel centred on n.h = 1 and 0.
TEST(LutAccuracy, CentredEndTexelsOverTheCosineReachTheKnownFigures) {
  constexpr std::array<Figure, 6> known{{{0.05, 6.1e-4, 5e-6},
                                         {0.1, 2.4e-4, 5e-6},
                                         {0.2, 6.9e-5, 5e-7},
                                         {0.4, 1.8e-5, 5e-7},
                                         {0.6, 8.0e-6, 5e-8},
                                         {1.0, 4.2e-6, 5e-8}}};
  for (const Figure& f : known) {
    EXPECT_NEAR(error_of_exponent(Coordinate::cosine, f.alpha, false), f.error, f.half_digit);
  }
}

/// 512 texels of -tan^2 at w(i), to be read at u.
Table table_by_hand(double (*distance)(int texel)) {
  Table table = bench::ward_table_of_512(TableKind::ward_exponent, Coordinate::cosine,
                                         Storage::r32f, 1, false);
  for (int i = 0; i < 512; ++i) {
    const double w = distance(i);
    table.texture.texels[static_cast<std::size_t>(i)] =
        static_cast<float>(-w * (2 - w) / ((1 - w) * (1 - w)));
  }
  return table;
}

double worst_error_by_hand(const Table& table, double alpha, double (*coordinate)(double w)) {
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const double w = i / 200000.0 * (i / 200000.0);
    const double value = lut::sample(table.texture, coordinate(w), 0.5, Filter::linear)[0];
    worst = std::max(worst,
                     std::abs(std::exp(value / (alpha * alpha)) - bench::ward_lobe_at(w, alpha)));
  }
  return worst;
}

// The same source, rows 2 and 4: texel i stands for (i + 1/2) / 512, read at c itself.
TEST(LutAccuracy, TablesWithoutATexelOnTheEndsReachTheKnownFigures) {
  const Table by_cosine = table_by_hand([](int i) { return 1 - (i + 0.5) / 512; });
  const auto cosine = [](double w) { return 1 - w; };
  EXPECT_NEAR(worst_error_by_hand(by_cosine, 0.05, cosine), 0.543, 5e-4);
  EXPECT_NEAR(worst_error_by_hand(by_cosine, 0.1, cosine), 0.178, 5e-4);
  EXPECT_NEAR(worst_error_by_hand(by_cosine, 1, cosine), 0.0020, 5e-5);
  const Table by_root = table_by_hand([](int i) { return (i + 0.5) / 512 * ((i + 0.5) / 512); });
  const auto root = [](double w) { return std::sqrt(w); };
  EXPECT_NEAR(worst_error_by_hand(by_root, 0.05, root), 7.6e-4, 5e-6);
  EXPECT_NEAR(worst_error_by_hand(by_root, 0.1, root), 1.9e-4, 5e-6);
  EXPECT_NEAR(worst_error_by_hand(by_root, 1, root), 7.6e-6, 5e-8);
}

// What was to be beaten with 512 texels of r32f: 6e-4 at 0.05, 1.9e-4 at 0.1. With the whole range
// of n.h, one table for every alpha; the fourth root gains a factor 5 to 10.
TEST(LutAccuracy, TheFourthRootServesEveryAlphaByOneTable) {
  EXPECT_LT(error_of_exponent(Coordinate::fourth_root, 0.05, false), 7.1e-5);
  EXPECT_LT(error_of_exponent(Coordinate::fourth_root, 0.1, false), 3.6e-5);
  for (const double alpha : {0.05, 0.1, 0.2}) {
    EXPECT_LT(2.5 * error_of_exponent(Coordinate::fourth_root, alpha, false),
              error_of_exponent(Coordinate::sqrt, alpha, false));
  }
}

// A table for one alpha that ends where its lobe does. Its exponent is nearly linear in n.h; with
// weights of 8 bits the steps of exponent 16/511 per texel show, of which the root spares half.
TEST(LutAccuracy, ATableThatEndsWithTheLobeErrsByMillionths) {
  for (const double alpha : {0.05, 0.1, 0.2, 0.4, 1.0}) {
    EXPECT_LT(error_of_exponent(Coordinate::cosine, alpha, true), 4e-6);
    EXPECT_LT(error_of_exponent(Coordinate::cosine, alpha, true, Weights::quantised),
              16.0 / 511 / 512);
    EXPECT_LT(error_of_exponent(Coordinate::sqrt, alpha, true, Weights::quantised), 2.4e-5);
  }
  EXPECT_LT(error_of_exponent(Coordinate::cosine, 0.05, true), 5e-7);
}

// Half a step of 16/65535 of exponent is an error of up to 1.2e-4; the lobe itself in 16 bits errs
// by 1/131070, a half by 2^-12 of it, in 8 bits by 1/510.
TEST(LutAccuracy, SixteenBitIntegersOfTheLobeAreTheBestOfTheSmallStorages) {
  const auto error = [](TableKind kind, Storage storage) {
    return error_of(kind, Coordinate::sqrt, storage, 0.1, true);
  };
  EXPECT_LT(error(TableKind::ward_lobe, Storage::unorm16), 2.0e-5);
  EXPECT_NEAR(error(TableKind::ward_exponent, Storage::unorm16), 1.22e-4, 5e-6);
  EXPECT_NEAR(error(TableKind::ward_exponent, Storage::r16f), 1.5e-4, 2e-5);
  EXPECT_NEAR(error(TableKind::ward_lobe, Storage::r16f), 0x1p-12, 2e-6);
  EXPECT_NEAR(error(TableKind::ward_lobe, Storage::unorm8), 1.0 / 510, 1e-5);
  EXPECT_GT(error(TableKind::ward_exponent, Storage::unorm8), 0.02);
}

// A half rounds by up to 2^-11 of the exponent x, and x exp(-x) is at most 1/e; 2.4e-5 is the
// table's own. Without a scale the exponents of small alphas would be below the smallest halves.
constexpr double half_rounding = 0x1p-11 / std::numbers::e;

TEST(LutAccuracy, HalfFloatsOfTheExponentServeEverySizeOfLobe) {
  for (const double alpha : {1e-4, 1e-3, 1e-2, 0.05, 0.5, 1.0}) {
    EXPECT_LT(error_of(TableKind::ward_exponent, Coordinate::sqrt, Storage::r16f, alpha, true),
              half_rounding + 2.4e-5)
        << alpha;
  }
}

/// The error for an alpha far smaller than the table's largest: at angles denser at the peak.
double error_for_narrowest(lut::Layout layout, Storage storage) {
  layout.storage = storage;
  const Table table = lut::bake(layout);
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const double w = std::pow(i / 100000.0, 4);
    const double value = lut::look_up(table, w, 0.0, Filter::linear, Weights::exact)[0];
    const double found = std::exp(value / (layout.lowest * layout.lowest));
    worst = std::max(worst, std::abs(found - bench::ward_lobe_at(w, layout.lowest)));
  }
  return worst;
}

// At the ratio allowed the narrowest lobe has exponents of 2^-25 / 2^10 of the largest alpha's
// square at most, 2000^2 times that of its own: 1.2e-4 on top of the rounding.
TEST(LutAccuracy, HalfFloatsServeLobesAsFarApartAsTheyAreAllowed) {
  for (const double highest : {10.0, 0.3, 0.2}) {
    lut::Layout layout{.coordinate = Coordinate::fourth_root,
                       .width = 4096,
                       .lowest = highest / lut::most_alphas_of_half,
                       .highest = highest};
    layout.reach = lut::lobe_reach(layout);
    EXPECT_LT(error_for_narrowest(layout, Storage::r16f),
              error_for_narrowest(layout, Storage::r32f) + half_rounding + 1.2e-4)
        << highest;
  }
}

/// The cells of a row of a Markdown table, without their blanks; empty for other lines.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  if (!line.starts_with('|')) return cells;
  std::istringstream rest(line.substr(1));
  for (std::string cell; std::getline(rest, cell, '|');) {
    const std::size_t first = cell.find_first_not_of(' ');
    const std::size_t last = cell.find_last_not_of(' ');
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

/// The rows of the page that begin with a table's name and have so many cells.
std::vector<std::vector<std::string>> rows_of_page(std::size_t cell_count) {
  std::ifstream page(GONIO_SOURCE_DIR "/docs/lut.md");
  EXPECT_TRUE(page) << "docs/lut.md cannot be read";
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(page, line);) {
    std::vector<std::string> cells = cells_of(line);
    if (cells.size() != cell_count) continue;
    const auto is_named = [&](TableKind kind) { return lut::name_of(kind) == cells[0]; };
    if (std::ranges::any_of(lut::all_table_kinds, is_named)) rows.push_back(std::move(cells));
  }
  return rows;
}

void expect_on_page(const bench::AccuracyTable& table) {
  const auto rows = rows_of_page(table.titles.size());
  ASSERT_EQ(rows.size(), table.rows.size()) << "build/release/bin/table_accuracy prints them";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto& [words, errors] = table.rows[r];
    const auto end_of_words = rows[r].begin() + static_cast<std::ptrdiff_t>(words.size());
    EXPECT_EQ(std::vector(rows[r].begin(), end_of_words), words);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      // Two digits are stated; another library's rounding may turn a last digit.
      const double stated = std::stod(rows[r][words.size() + i]);
      EXPECT_NEAR(errors[i], stated, 0.06 * std::pow(10, std::floor(std::log10(stated))))
          << bench::markdown_of({table.titles, {table.rows[r]}});
    }
  }
}

TEST(LutAccuracy, ThePageOnTablesStatesTheErrorsThatTheyHave) {
  expect_on_page(bench::accuracy_of_one_lobe());
  expect_on_page(bench::accuracy_of_two_axes());
}

}  // namespace
}  // namespace gonio::tests
