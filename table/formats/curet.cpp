#include "table/formats/curet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "table/file_error.h"
#include "table/formats/columns.h"
#include "table/formats/curet_partner.h"
#include "table/formats/row_fields.h"
#include "table/formats/sample_writer.h"
#include "table/formats/text_lines.h"
#include "table/formats/text_rows.h"
#include "table/input_file.h"

namespace gonio::table {

namespace {

/// A line of numbers.
struct Row {
  std::size_t line;
  std::string_view text;
  std::vector<double> fields;
};

/// One of the two files: the first column numbers its rows.
struct NumberedRows {
  TextRows text;
  std::vector<Row> rows;
};

std::string place(const NumberedRows& file, const Row& row) {
  return fmt::format("{}:{}", file.text.path, row.line);
}

/// The bytes of one of the two files, and its path for messages.
struct Bytes {
  std::string_view content;
  std::string path;
};

NumberedRows read_numbers(const Bytes& file, Columns columns) {
  NumberedRows result{.text = {.text = without_byte_order_mark(file.content),
                               .first_line = 1,
                               .path = file.path,
                               .separator = Separator::blank,
                               .columns = std::move(columns)},
                      .rows = {}};
  LineReader lines(result.text.text);
  for (std::string_view line; lines.next(line);) {
    if (line.empty() || line.starts_with('#')) continue;
    Row row{lines.number(), line, std::vector<double>(result.text.columns.names.size())};
    const char* at = line.data();
    const RowProblem problem =
        read_fields(at, line.data() + line.size(), Separator::blank, row.fields);
    if (problem.fault != RowFault::none) {
      throw FileError(explain(problem, result.text, AngleUnit::radians, row.line, line));
    }
    result.rows.push_back(std::move(row));
  }
  if (result.rows.empty()) {
    throw FileError(fmt::format("{}: no row of numbers: name a file of CUReT's format", file.path));
  }
  return result;
}

/// The columns of the directions. Behind them a sample has a measurement, of the other file.
Columns direction_columns() {
  return {.names = {"index", "theta_v", "phi_v", "theta_i", "phi_i"},
          .angles = {3, 4, 1, 2},  // theta_i, phi_i, theta_o, phi_o: the viewer is wo
          .channels = {"mean"},
          .values = {5},
          .sigmas = {},
          .weight = {},
          .ignored = {},
          .constants = {}};
}

NumberedRows read_directions(const Bytes& file) {
  NumberedRows directions = read_numbers(file, direction_columns());
  for (std::size_t i = 0; i < directions.rows.size(); ++i) {
    const Row& row = directions.rows[i];
    if (row.fields[0] == double(i + 1)) continue;
    throw FileError(fmt::format(
        "{}: index {}, expected {}: the measurements are assigned by the order of these lines: "
        "put them in order, without gaps",
        place(directions, row), row.fields[0], i + 1));
  }
  return directions;
}

Columns measurement_columns(std::size_t directions) {
  Columns columns;
  columns.names.emplace_back("material");
  for (std::size_t i = 1; i <= directions; ++i) {
    columns.names.push_back(fmt::format("measurement {}", i));
  }
  return columns;
}

void require_whole_and_distinct_numbers(const NumberedRows& measurements) {
  constexpr double largest = std::numeric_limits<int>::max();
  std::map<double, std::size_t> lines;
  for (const Row& row : measurements.rows) {
    const double number = row.fields[0];
    if (number != std::floor(number) || number < 1 || number > largest) {
      throw FileError(fmt::format(
          "{}: material {}, expected a whole number from 1 on: begin each row with its material",
          place(measurements, row), number));
    }
    const auto [first, is_new] = lines.emplace(number, row.line);
    if (is_new) continue;
    throw FileError(fmt::format("{}: material {} stands in line {} already: remove one of them",
                                place(measurements, row), number, first->second));
  }
}

/// A pair of files, read; refers to their bytes.
struct Pair {
  Pair(const Bytes& measurements_file, const Bytes& directions_file)
      : directions(read_directions(directions_file)),
        measurements(read_numbers(measurements_file, measurement_columns(directions.rows.size()))) {
    require_whole_and_distinct_numbers(measurements);
  }

  NumberedRows directions, measurements;
};

/// The measurement as it is, NaN for a hole.
double measured(double written) {
  return written > 0 ? written : std::numeric_limits<double>::quiet_NaN();
}

void write_samples(const Row& material, const NumberedRows& directions, SampleTable& table) {
  const std::size_t count = directions.rows.size();
  table.channels = directions.text.columns.channels;
  table.wi.resize(count);
  table.wo.resize(count);
  table.values.assign(1, std::vector<double>(count));
  table.mask.resize(count, MaskReason::none);
  const SampleWriter writer(directions.text.columns, Quantity::brdf, AngleUnit::radians, table);
  for (std::size_t i = 0; i < count; ++i) {
    const Row& direction = directions.rows[i];
    std::vector<double> fields = direction.fields;
    fields.push_back(measured(material.fields[i + 1]));
    const RowProblem problem = writer.write(fields, i);
    if (problem.fault == RowFault::none) continue;
    throw FileError(
        explain(problem, directions.text, AngleUnit::radians, direction.line, direction.text));
  }
}

SampleTable table_of(const Row& material, const Pair& pair) {
  SampleTable table;
  table.name = fmt::format("CUReT {}", material.fields[0]);
  table.provenance = {.path = pair.measurements.text.path,
                      .format = "CUReT",
                      .sha256 = {},
                      .quantity = Quantity::brdf,
                      .angles = AngleUnit::radians};
  write_samples(material, pair.directions, table);
  const auto holes = std::count_if(material.fields.begin() + 1, material.fields.end(),
                                   [](double written) { return std::isnan(measured(written)); });
  if (holes > 0) {
    table.notes.push_back(
        fmt::format("{} of the {} readings are 0 or negative: they were taken as not measured",
                    holes, table.size()));
  }
  return table;
}

SampleTable table_of_material(int material, const Pair& pair) {
  const std::vector<Row>& rows = pair.measurements.rows;
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.fields[0] == material; });
  if (row == rows.end()) {
    throw FileError(
        fmt::format("{}: no material {}: the file holds {}, the first is {}, the last {}",
                    pair.measurements.text.path, material, rows.size(), rows.front().fields[0],
                    rows.back().fields[0]));
  }
  return table_of(*row, pair);
}

}  // namespace

std::vector<SampleTable> read_curet(const CuretFiles& files) {
  const InputFile measurements(files.measurements);
  const InputFile directions(files.directions);
  const Pair pair({measurements.bytes(), files.measurements},
                  {directions.bytes(), files.directions});
  std::vector<SampleTable> tables;
  for (const Row& material : pair.measurements.rows) tables.push_back(table_of(material, pair));
  return tables;
}

SampleTable read_curet(const CuretFiles& files, int material) {
  const InputFile measurements(files.measurements);
  const InputFile directions(files.directions);
  return table_of_material(material, Pair({measurements.bytes(), files.measurements},
                                          {directions.bytes(), files.directions}));
}

bool is_curet(std::string_view content) { return curet_kind(content) != CuretKind::none; }

SampleTable read_curet_file(std::string_view content, const std::string& path,
                            const ReadOptions& options) {
  const CuretPartner partner(content, path);
  const Bytes given{content, path};
  const Bytes other{partner.content(), partner.path()};
  const bool has_measurements = curet_kind(content) == CuretKind::measurements;
  const Pair pair(has_measurements ? given : other, has_measurements ? other : given);
  const std::vector<Row>& rows = pair.measurements.rows;
  if (!options.material && rows.size() > 1) {
    const auto [least, largest] =
        std::minmax_element(rows.begin(), rows.end(),
                            [](const Row& a, const Row& b) { return a.fields[0] < b.fields[0]; });
    throw FileError(fmt::format("{}: holds materials {} to {}: choose one with --material N",
                                pair.measurements.text.path, least->fields[0], largest->fields[0]));
  }
  SampleTable table =
      options.material ? table_of_material(*options.material, pair) : table_of(rows.front(), pair);
  table.provenance.path = path;
  table.notes.push_back(fmt::format("the {} were read from {}",
                                    has_measurements ? "directions" : "measurements",
                                    partner.path()));
  return table;
}

}  // namespace gonio::table
