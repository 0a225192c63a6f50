// gonio convert CSV: many lobes, one a row. The output repeats the input's columns and adds
// to,to_<shape>,to_<amplitude>,method,metric_error,peak,rms,albedo,problem. A row that cannot be
// converted keeps its place, with the problem in the last column.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "apps/gonio/convert.h"
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

Columns columns_of(std::string_view header, const std::string& path, std::size_t line) {
  Columns columns;
  const auto names = split_fields(header, table::Separator::comma);
  columns.count = names.size();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string_view name = names[k];
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
             fmt::format("column {} stands twice: {}", table::quoted(name), header_help));
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

std::string lobe_of(const Columns& columns, const Row& row, const ConvertArguments& arguments) {
  if (columns.lobe >= 0) return row.fields[static_cast<std::size_t>(columns.lobe)];
  if (!arguments.lobe.empty()) return arguments.lobe;
  if (columns.alpha >= 0) return "ward";
  return "blinn-phong";
}

double shape_of(const Columns& columns, const Row& row, std::string_view term) {
  const bool is_ward = term.starts_with("ward");
  if (is_ward != (columns.alpha >= 0)) {
    throw std::invalid_argument(fmt::format("the width of {} is given in a column {}", term,
                                            is_ward ? "alpha" : "exponent"));
  }
  if (is_ward) {
    const double alpha = number_in(row, columns.alpha, "alpha");
    if (alpha >= 1e-4 && alpha <= 10) return alpha;
    throw std::invalid_argument(fmt::format("alpha is {:g}, expected 0.0001 to 10", alpha));
  }
  const double exponent = number_in(row, columns.exponent, "exponent");
  if (exponent > 0 && exponent <= 1e6) return exponent;
  throw std::invalid_argument(
      fmt::format("exponent is {:g}, expected more than 0 and up to 1e6", exponent));
}

double amplitude_of(const Columns& columns, const Row& row, std::string_view term, double shape,
                    material::Amplitude convention) {
  const std::string_view own = term.starts_with("ward")      ? "rho_s"
                               : term == "ashikhmin-shirley" ? "Rs"
                                                             : "ks";
  double value = own == "Rs" ? 0.05 : 1;
  if (columns.amplitude >= 0) {
    if (columns.amplitude_name != own) {
      throw std::invalid_argument(fmt::format("the amplitude of {} is {}, the column is {}", term,
                                              own, columns.amplitude_name));
    }
    value = number_in(row, columns.amplitude, own);
  }
  if (!(value >= 0 && value <= (own == "Rs" ? 1 : 1e6))) {
    throw std::invalid_argument(
        fmt::format("{} is {:g}, expected 0 to {}", own, value, own == "Rs" ? "1" : "1e6"));
  }
  return own == "ks" ? material::raw_amplitude(convention, value, shape) : value;
}

/// Throws std::invalid_argument for a row that cannot be converted.
Conversion convert_row(const LobeList& list, const Row& row, const ConvertArguments& arguments,
                       const std::string& to, const material::ConversionOptions& options) {
  const Columns& columns = list.columns;
  if (row.fields.size() != columns.count) {
    throw std::invalid_argument(
        fmt::format("{} fields, expected {}", row.fields.size(), columns.count));
  }
  const auto convention = arguments.amplitude.empty()
                              ? material::Amplitude::raw
                              : material::amplitude_from_name(arguments.amplitude);
  const std::string term = lobe_of(columns, row, arguments);
  const double shape = shape_of(columns, row, term);
  const double amplitude = amplitude_of(columns, row, term, shape, convention);
  return convert(material::LobeMaterial{.name = {},
                                        .channels = {"Y"},
                                        .rho_d = {0},
                                        .lobe = {term, shape, {amplitude}},
                                        .is_classic = convention == material::Amplitude::classic &&
                                                      term.ends_with("phong")},
                 to, options);
}

std::string result_fields(const Conversion& c) {
  const auto& parameters = c.material.parameters;
  return fmt::format("{},{},{},{},{},{},{},{},", c.material.model.substr(sizeof("lambert")),
                     parameters[2].value.front(), parameters[1].value.front(),
                     c.material.conversion->method, c.metric_error, c.remaining.peak,
                     c.remaining.rms, c.remaining.albedo);
}

/// A problem as the last field: no commas, which would end it.
std::string problem_fields(std::string problem) {
  std::replace(problem.begin(), problem.end(), ',', ';');
  return ",,,,,,,," + problem;
}

/// The names of the target's amplitude and shape.
std::array<std::string, 2> parameter_names(const std::string& to) {
  const brdf::Model model("lambert+" + to);
  return {model.amplitudes()[1].name, model.shape()[0].name};
}

}  // namespace

void convert_csv(const ConvertArguments& arguments, Invocation& invocation) {
  if (arguments.json) {
    throw std::invalid_argument("convert CSV: the result is a CSV; --json is for one lobe");
  }
  const std::string to = target_term_in(arguments);
  const material::ConversionOptions options = conversion_options_in(arguments);
  const LobeList list = read_lobes(arguments.source);
  const auto [amplitude, shape] = parameter_names(to);
  std::string text = fmt::format("{},to,to_{},to_{},method,metric_error,peak,rms,albedo,problem\n",
                                 list.header, shape, amplitude);
  for (const Row& row : list.rows) {
    text += fmt::format("{},", fmt::join(row.fields, ","));
    try {
      text += result_fields(convert_row(list, row, arguments, to, options));
    } catch (const std::invalid_argument& error) {
      text += problem_fields(error.what());
      print_note(fmt::format("{}:{}: {}", arguments.source, row.line, error.what()));
      invocation.exit_status = 1;
    }
    text += '\n';
  }
  if (arguments.output.empty()) {
    print(text);
  } else {
    table::write_file(arguments.output, text);
  }
}

}  // namespace gonio::app
