// gonio convert CSV: many lobes, one a row. The output repeats the input's columns and adds
// to,to_<shape>,to_<amplitude>,method,metric_error,peak,rms,albedo,problem. A row that cannot be
// converted keeps its place, with the problem in the last column.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "apps/gonio/convert.h"
#include "apps/gonio/progress.h"
#include "table/file_error.h"
#include "table/formats/row_fields.h"
#include "table/formats/text_lines.h"
#include "table/input_file.h"
#include "table/output_file.h"

namespace gonio::app {
namespace {

using material::Conversion;

/// Which column says what; -1 where there is none.
struct Columns {
  int name = -1;
  int lobe = -1;
  int exponent = -1;
  int alpha = -1;
  int amplitude = -1;
  std::string amplitude_name;
  std::size_t count = 0;
};

struct Row {
  std::size_t line;
  std::vector<std::string> fields;
};

struct LobeList {
  std::string header;
  Columns columns;
  std::vector<Row> rows;
};

constexpr std::string_view header_help =
    "the first line names the columns: exponent or alpha, and if wanted name, lobe and one of ks, "
    "rho_s and Rs";

[[noreturn]] void refuse(const std::string& path, std::size_t line, const std::string& problem) {
  throw table::FileError(fmt::format("{}:{}: {}", path, line, problem));
}

/// As spreadsheets write names: "exponent".
std::string_view unquoted(std::string_view name) {
  const bool is_quoted = name.size() > 2 && name.front() == '"' && name.back() == '"';
  return is_quoted ? name.substr(1, name.size() - 2) : name;
}

Columns columns_of(std::string_view header, const std::string& path, std::size_t line) {
  Columns columns;
  const auto names = split_fields(header, table::Separator::comma);
  columns.count = names.size();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string_view name = unquoted(names[k]);
    const bool is_amplitude = name == "ks" || name == "rho_s" || name == "Rs";
    int* column = name == "name"       ? &columns.name
                  : name == "lobe"     ? &columns.lobe
                  : name == "exponent" ? &columns.exponent
                  : name == "alpha"    ? &columns.alpha
                  : is_amplitude       ? &columns.amplitude
                                       : nullptr;
    if (column == nullptr) {
      refuse(path, line,
             fmt::format("there is no column {}: {}", table::quoted(name), header_help));
    }
    if (*column >= 0) {
      refuse(path, line,
             fmt::format("{} stands for what another column says already: {}", table::quoted(name),
                         header_help));
    }
    *column = static_cast<int>(k);
    if (is_amplitude) columns.amplitude_name = name;
  }
  if ((columns.exponent < 0) == (columns.alpha < 0)) {
    refuse(path, line,
           fmt::format("expected one of the columns exponent and alpha: {}", header_help));
  }
  return columns;
}

LobeList read_lobes(const std::string& path) {
  const table::InputFile file(path);
  LobeList list;
  table::LineReader lines(table::without_byte_order_mark(file.bytes()));
  for (std::string_view line; lines.next(line);) {
    if (line.empty() || line.starts_with('#')) continue;
    if (list.header.empty()) {
      list.header = line;
      list.columns = columns_of(line, path, lines.number());
      continue;
    }
    Row row{lines.number(), {}};
    for (const std::string_view field : split_fields(line, table::Separator::comma)) {
      row.fields.emplace_back(field);
    }
    list.rows.push_back(std::move(row));
  }
  if (list.header.empty()) refuse(path, 1, fmt::format("no columns are named: {}", header_help));
  if (list.rows.empty()) {
    throw table::FileError(fmt::format("{}: there is no row behind the column names", path));
  }
  return list;
}

double number_in(const Row& row, int column, std::string_view name) {
  const std::string& text = row.fields[static_cast<std::size_t>(column)];
  const auto value = parse_number(text);
  if (!value || !std::isfinite(*value)) {
    throw std::invalid_argument(
        fmt::format("{} is {}, expected a number", name, table::quoted(text)));
  }
  return *value;
}

std::string lobe_of(const Columns& columns, const Row& row, const std::string& usual) {
  const auto column = static_cast<std::size_t>(columns.lobe);
  if (columns.lobe < 0 || column >= row.fields.size() || row.fields[column].empty()) return usual;
  return row.fields[column];
}

double shape_of(const Columns& columns, const Row& row, std::string_view term) {
  const std::string_view width = width_name(term);
  if ((width == "alpha") != (columns.alpha >= 0)) {
    throw std::invalid_argument(
        fmt::format("the width of {} is given in a column {}", term, width));
  }
  const int column = width == "alpha" ? columns.alpha : columns.exponent;
  return checked_width(term, number_in(row, column, width));
}

double amplitude_of(const Columns& columns, const Row& row, std::string_view term, double shape,
                    material::Amplitude convention) {
  double value = default_amplitude(term);
  if (columns.amplitude >= 0) {
    if (columns.amplitude_name != amplitude_name(term)) {
      throw std::invalid_argument(fmt::format("the amplitude of {} is {}, the column is {}", term,
                                              amplitude_name(term), columns.amplitude_name));
    }
    value = number_in(row, columns.amplitude, amplitude_name(term));
  }
  value = checked_amplitude(term, value);
  return is_phong(term) ? material::raw_amplitude(convention, value, shape) : value;
}

/// What --amplitude says of the column ks. Throws std::invalid_argument if there can be none.
material::Amplitude convention_in(const ConvertArguments& arguments, const Columns& columns) {
  if (arguments.amplitude.empty()) return material::Amplitude::raw;
  if (columns.alpha >= 0) {
    throw std::invalid_argument(
        "--amplitude: is how the ks of a list of exponents is meant; this list is of roughness");
  }
  return material::amplitude_from_name(arguments.amplitude);
}

/// Throws std::invalid_argument for a row that cannot be converted.
Conversion convert_row(const Columns& columns, const Row& row, const std::string& term,
                       const std::string& to, material::Amplitude convention,
                       const material::ConversionOptions& options) {
  if (row.fields.size() != columns.count) {
    throw std::invalid_argument(
        fmt::format("{} fields, expected {}", row.fields.size(), columns.count));
  }
  const double shape = shape_of(columns, row, term);
  const double amplitude = amplitude_of(columns, row, term, shape, convention);
  return convert(material::LobeMaterial{.name = {},
                                        .channels = {"Y"},
                                        .rho_d = {0},
                                        .lobe = {term, shape, {amplitude}},
                                        .is_classic = convention == material::Amplitude::classic &&
                                                      is_phong(term)},
                 to, options);
}

std::string result_fields(const Conversion& c) {
  const material::Lobe lobe = material::lobe_material_of(c.material)->lobe;
  return fmt::format("{},{},{},{},{},{},{},{},", lobe.term, lobe.shape, lobe.amplitudes.front(),
                     c.material.conversion->method, c.material.conversion->metric_error,
                     c.remaining.peak, c.remaining.rms, c.remaining.albedo);
}

/// A problem as the last field: no commas, which would end it.
std::string problem_fields(std::string problem) {
  std::replace(problem.begin(), problem.end(), ',', ';');
  return ",,,,,,,," + problem;
}

/// The row's own fields, as many as there are columns.
std::string own_fields(const Row& row, const Columns& columns) {
  std::vector<std::string> fields = row.fields;
  fields.resize(columns.count);
  return fmt::format("{}", fmt::join(fields, ","));
}

/// The lobe that a list is of, where its rows do not say.
std::string usual_lobe(const Columns& columns, const ConvertArguments& arguments) {
  if (!arguments.lobe.empty()) return arguments.lobe;
  return columns.alpha >= 0 ? "ward" : "blinn-phong";
}

}  // namespace

void convert_csv(const ConvertArguments& arguments, Invocation& invocation) {
  if (arguments.json) {
    throw std::invalid_argument("convert CSV: the result is a CSV; --json is for one lobe");
  }
  refuse_overwriting(arguments.source, arguments.output);
  const material::ConversionOptions options = conversion_options_in(arguments);
  const LobeList list = read_lobes(arguments.source);
  const Columns& columns = list.columns;
  const std::string usual = usual_lobe(columns, arguments);
  const std::string to = target_term_in(arguments, default_target(usual));
  const material::Amplitude convention = convention_in(arguments, columns);
  std::string text =
      fmt::format("{},to,to_{},to_{},method,metric_error,peak,rms,albedo,problem\n", list.header,
                  material::shape_parameter(to).name, amplitude_name(to));
  ProgressLine progress("converting " + arguments.source);
  for (const Row& row : list.rows) {
    text += own_fields(row, columns) + ",";
    try {
      const std::string term = lobe_of(columns, row, usual);
      text += result_fields(convert_row(columns, row, term, to, convention, options));
    } catch (const std::invalid_argument& error) {
      text += problem_fields(error.what());
      print_note(fmt::format("{}:{}: {}", arguments.source, row.line, error.what()));
      invocation.exit_status = 1;
    }
    text += '\n';
    progress.set("converting " + arguments.source,
                 double(&row - list.rows.data()) / double(list.rows.size()));
  }
  if (arguments.output.empty()) {
    print(text);
  } else {
    table::write_file(arguments.output, text);
  }
}

}  // namespace gonio::app
