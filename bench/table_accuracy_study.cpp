#include "bench/table_accuracy_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "brdf/strauss.h"

namespace gonio::bench {
namespace {

using lut::Coordinate;
using lut::Filter;
using lut::Layout;
using lut::Storage;
using lut::Table;
using lut::TableKind;
using lut::Weights;

constexpr std::array alphas{0.05, 0.1, 0.2, 0.4, 1.0};

std::string text_of(std::string_view text) { return std::string(text); }

std::string_view name_of(Weights weights) { return weights == Weights::exact ? "exact" : "1/256"; }

/// Ward's numerator as the table has it.
double ward_by_table(const Table& table, double w, double alpha, Filter filter, Weights weights) {
  const double value = lut::look_up(table, w, alpha, filter, weights)[0];
  if (table.layout.kind == TableKind::ward_lobe) return value;
  const bool is_beyond = value <= double{lut::end_of_exponent(table.layout)};
  return is_beyond ? 0 : std::exp(value / (alpha * alpha));
}

AccuracyRow row_of_one_lobe(TableKind kind, Coordinate coordinate, bool reaches_lobe,
                            Storage storage, Weights weights) {
  AccuracyRow row{
      {text_of(lut::name_of(kind)), text_of(lut::name_of(coordinate)),
       reaches_lobe ? "lobe" : "full", text_of(lut::name_of(storage)), text_of(name_of(weights))},
      {}};
  for (const double alpha : alphas) {
    const Table table = ward_table_of_512(kind, coordinate, storage, alpha, reaches_lobe);
    row.errors.push_back(worst_ward_error(table, alpha, Filter::linear, weights));
  }
  return row;
}

/// Of a table for a range, at lobes in and between its rows; the angles are denser near the peak
/// than worst_ward_error()'s, for the narrowest of them.
double worst_error_over_range(const Table& table, Weights weights) {
  // Steps of 63/40 of the gap between two of 64 rows: each but the last meets another share of it.
  constexpr int lobes = 41;
  constexpr int angles = 20000;
  const Layout& layout = table.layout;
  double worst = 0;
  for (int k = 0; k < lobes; ++k) {
    const double share = static_cast<double>(k) / (lobes - 1);
    const double parameter = layout.lowest * std::pow(layout.highest / layout.lowest, share);
    for (int i = 0; i < angles; ++i) {
      const double w = std::pow(static_cast<double>(i) / angles, 4);
      const double exact = layout.kind == TableKind::ward_lobe ? ward_lobe_at(w, parameter)
                                                               : std::pow(1 - w, parameter);
      const double found = lut::look_up(table, w, parameter, Filter::linear, weights)[0];
      worst = std::max(worst, std::abs(found - exact));
    }
  }
  return worst;
}

/// What strauss-j holds, by the model's functions.
std::array<double, 2> strauss_j_at(bool of_cosine, double cosine_in, double cosine_out) {
  using namespace brdf::strauss_detail;  // NOLINT(google-build-using-namespace)
  const auto argument = [&](double cosine) {
    const brdf::Direction<double> direction{std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine};
    return of_cosine ? brdf::StraussCosine::argument(direction)
                     : brdf::StraussAngle::argument(direction);
  };
  const auto in = argument(cosine_in);
  const auto out = argument(cosine_out);
  const auto f = fresnel(in);
  return {f.per_x * in.x * attenuation(in) * attenuation(out),
          f.complement_per_complement * in.complement};
}

/// Of strauss-j, over both cosines, denser where they are small.
double worst_strauss_error(const Table& table, Weights weights) {
  constexpr int steps = 1499;  // a prime: in step with no size of a table
  const bool of_cosine = table.layout.of_cosine;
  double worst = 0;
  for (int i = 0; i <= steps; ++i) {
    const double in = std::pow(static_cast<double>(i) / steps, 2);
    for (int k = 0; k <= steps; ++k) {
      const double out = std::pow(static_cast<double>(k) / steps, 2);
      const auto exact = strauss_j_at(of_cosine, in, out);
      const auto found = lut::look_up(table, of_cosine ? 1 - in : in, of_cosine ? 1 - out : out,
                                      Filter::linear, weights);
      worst = std::max({worst, std::abs(found[0] - exact[0]), std::abs(found[1] - exact[1])});
    }
  }
  return worst;
}

/// Errors with exact and with quantised weights.
AccuracyRow row_of_two_axes(Layout layout) {
  layout.reach = lut::lobe_reach(layout);
  const Table table = lut::bake(layout);
  const bool is_strauss = layout.kind == TableKind::strauss_j;
  AccuracyRow row{{text_of(lut::name_of(layout.kind)),
                   is_strauss ? (layout.of_cosine ? "strauss-listing" : "strauss")
                              : fmt::format("{:g} to {:g}", layout.lowest, layout.highest),
                   fmt::format("{} x {}", layout.width, layout.height),
                   text_of(lut::name_of(layout.coordinate)), text_of(lut::name_of(layout.storage))},
                  {}};
  for (const Weights weights : {Weights::exact, Weights::quantised}) {
    row.errors.push_back(is_strauss ? worst_strauss_error(table, weights)
                                    : worst_error_over_range(table, weights));
  }
  return row;
}

std::string markdown_line(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += fmt::format(" {} |", cell);
  return line + "\n";
}

}  // namespace

double ward_lobe_at(double w, double alpha) {
  const double cosine = 1 - w;
  return std::exp(-w * (2 - w) / (cosine * cosine * alpha * alpha));
}

double worst_ward_error(const Table& table, double alpha, Filter filter, Weights weights) {
  constexpr int angles = 200000;
  double worst = 0;
  for (int i = 0; i < angles; ++i) {
    const double root = static_cast<double>(i) / angles;
    const double w = root * root;
    const double found = ward_by_table(table, w, alpha, filter, weights);
    worst = std::max(worst, std::abs(found - ward_lobe_at(w, alpha)));
  }
  return worst;
}

Table ward_table_of_512(TableKind kind, Coordinate coordinate, Storage storage, double alpha,
                        bool reaches_lobe) {
  Layout layout{.kind = kind,
                .coordinate = coordinate,
                .storage = storage,
                .lowest = alpha,
                .highest = alpha};
  if (reaches_lobe) layout.reach = lut::lobe_reach(layout);
  return lut::bake(layout);
}

AccuracyTable accuracy_of_one_lobe() {
  AccuracyTable table{{"table", "coordinate", "reach", "storage", "weights"}, {}};
  for (const double alpha : alphas) table.titles.push_back(fmt::format("{:g}", alpha));
  const auto add = [&](TableKind kind, Coordinate coordinate, bool reaches_lobe, Storage storage,
                       Weights weights) {
    table.rows.push_back(row_of_one_lobe(kind, coordinate, reaches_lobe, storage, weights));
  };
  constexpr std::array rooted{Coordinate::cosine, Coordinate::sqrt, Coordinate::fourth_root};
  constexpr std::array both{Weights::exact, Weights::quantised};
  add(TableKind::ward_exponent, Coordinate::listing, false, Storage::r32f, Weights::exact);
  for (const bool reaches_lobe : {false, true}) {
    for (const Coordinate coordinate : rooted) {
      for (const Weights weights : both) {
        add(TableKind::ward_exponent, coordinate, reaches_lobe, Storage::r32f, weights);
      }
    }
  }
  for (const Coordinate coordinate : rooted) {
    for (const Weights weights : both) {
      add(TableKind::ward_lobe, coordinate, true, Storage::r32f, weights);
    }
  }
  for (const TableKind kind : {TableKind::ward_exponent, TableKind::ward_lobe}) {
    for (const Storage storage : {Storage::r16f, Storage::unorm16, Storage::unorm8}) {
      add(kind, Coordinate::sqrt, true, storage, Weights::quantised);
    }
  }
  return table;
}

AccuracyTable accuracy_of_two_axes() {
  AccuracyTable table{{"table", "for", "texels", "coordinate", "storage", "exact", "1/256"}, {}};
  const auto add = [&](const Layout& layout) { table.rows.push_back(row_of_two_axes(layout)); };
  const auto of_range = [](TableKind kind, double lowest, double highest, Coordinate coordinate) {
    return Layout{.kind = kind,
                  .coordinate = coordinate,
                  .height = lut::rows_of_a_range,
                  .lowest = lowest,
                  .highest = highest};
  };
  constexpr std::array rooted{Coordinate::cosine, Coordinate::sqrt, Coordinate::fourth_root};
  for (const Coordinate coordinate : rooted) {
    add(of_range(TableKind::ward_lobe, 0.05, 0.5, coordinate));
  }
  for (const double lowest : {0.02, 1e-3}) {
    add(of_range(TableKind::ward_lobe, lowest, 1, Coordinate::fourth_root));
  }
  for (const Storage storage : {Storage::r16f, Storage::unorm16, Storage::unorm8}) {
    Layout layout = of_range(TableKind::ward_lobe, 0.05, 0.5, Coordinate::fourth_root);
    layout.storage = storage;
    add(layout);
  }
  for (const Coordinate coordinate : rooted) {
    add(of_range(TableKind::blinn_phong_power, 10, 1000, coordinate));
  }
  for (const bool of_cosine : {false, true}) {
    for (const Coordinate coordinate : rooted) {
      add({.kind = TableKind::strauss_j,
           .coordinate = coordinate,
           .height = 512,
           .of_cosine = of_cosine});
    }
  }
  return table;
}

std::string markdown_of(const AccuracyTable& table) {
  std::string text = markdown_line(table.titles);
  text += "|";
  for (std::size_t i = 0; i < table.titles.size(); ++i) text += "---|";
  text += "\n";
  for (const AccuracyRow& row : table.rows) {
    std::vector<std::string> cells = row.words;
    for (const double error : row.errors) cells.push_back(fmt::format("{:.1e}", error));
    text += markdown_line(cells);
  }
  return text;
}

}  // namespace gonio::bench
