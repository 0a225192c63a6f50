#include "bench/extremes_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>

#include "bench/extremes_regions.h"
#include "table/input_file.h"

namespace gonio::bench {
namespace {

// Errors below these are not told apart: a few roundings more or less.
constexpr double double_floor = 1e-15;
constexpr double float_floor = 5e-7;
/// A stated bound is at most this many times the measured error, or the floor.
constexpr double widest = 10;

/// The errors as measured; of models with a condition those of the inputs that it does not excuse.
StatedErrors measured(std::string subject, std::span<const RegionErrors> regions) {
  StatedErrors errors{std::move(subject), 0, 0, 0, 0};
  const auto raise = [](double& worst, double value) { worst = std::max(worst, value); };
  for (const RegionErrors& r : regions) {
    raise(errors.double_error, r.in_double.well_conditioned);
    raise(errors.float_of_peak, r.in_float.well_conditioned_of_peak);
    raise(errors.naive_double_error, r.in_double.naive.relative.worst);
    raise(errors.naive_float_of_peak, r.in_float.naive.of_peak);
  }
  return errors;
}

PageBounds measured_errors(std::span<const ModelErrors> models) {
  PageBounds errors;
  for (const ModelErrors& model : models) {
    errors.models.push_back(measured("`" + model.name + "`", model.regions));
  }
  for (std::size_t r = 0; r < regions().size(); ++r) {
    std::vector<RegionErrors> of_all;
    for (const ModelErrors& model : models) of_all.push_back(model.regions[r]);
    errors.regions.push_back(measured(std::string(regions()[r].name), of_all));
  }
  return errors;
}

/// Twice the error, rounded up to one digit; not above the project's figure where that is reached.
double upper_bound(double error, double floor, double figure) {
  const double wanted = std::max(2 * error, floor);
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  const double bound = std::ceil(wanted / power * (1 - 1e-9)) * power;
  return error <= figure ? std::min(bound, figure) : bound;
}

/// A power of ten that is at most a third of the naive form's error, and at most 1: such an error
/// is a value that has nothing to do with the truth. 0 where the stable form's bound is no better.
double lower_bound(double error, double stable_bound) {
  const double bound =
      error > 3 ? 1 : std::pow(10, std::floor(std::log10(std::max(error, 1e-300) / 3)));
  return bound > 3 * stable_bound ? bound : 0;
}

std::string bound_text(double bound) { return bound == 0 ? "-" : fmt::format("{:.0e}", bound); }

std::string row(const StatedErrors& e, std::string_view about) {
  return fmt::format("| {} | {} | {} | {} | {} | {} |\n", e.subject, bound_text(e.double_error),
                     bound_text(e.float_of_peak), bound_text(e.naive_double_error),
                     bound_text(e.naive_float_of_peak), about);
}

std::string parameter_ranges(const ModelErrors& model) {
  std::string text;
  for (const brdf::Parameter& p : model.shape) {
    fmt::format_to(std::back_inserter(text), "{}{} {:.4g} to {:.4g}", text.empty() ? "" : ", ",
                   p.name, p.lower, p.upper);
  }
  return text.empty() ? "none" : text;
}

double largest(std::span<const StatedErrors> errors, double StatedErrors::*of) {
  double value = 0;
  for (const StatedErrors& e : errors) value = std::max(value, e.*of);
  return value;
}

std::string introduction(const PageBounds& bounds) {
  return fmt::format(
      R"(# At the extremes: what double and float are worth

For whoever evaluates a model at grazing angles, in sharp lobes or at the ends of its parameters'
ranges. The numbers come from `build/release/bin/extremes`, which prints them for each model and
region; a test runs it and compares. `bench/extremes --update` writes this page anew.

## What you may rely on

- **double**: where f_r cos_i exceeds {lit:g} of its peak, the relative error is at most {d:.0e}, for every
  model, in every region below and over the whole range of its parameters.
- **float**: the error is at most {f:.0e} of the lobe's peak, for every model and region, with alpha from
  {alpha:g} and exponents to {exponent:g} (Strauss's is 3/(1 - s)). In sharper lobes, and as a fraction of
  a value that is itself far below the peak, float may err by more.
- **Never NaN, infinity or a negative value**, in double or in float, for any parameters within their
  bounds and any unit directions: on the horizon, below it, at the pole, with denormal cosines.
  `scripts/extremes` counts 1e8 evaluations of each model in each precision, half of them there.
- These are errors of the evaluation, for the components of the directions as they are given. Where
  the value itself follows their last digits, as that of a sharp lobe at grazing angles does, the
  rounding of the input comes on top; no formula can undo it.

)",
      fmt::arg("lit", lit_share),
      fmt::arg("d", largest(bounds.models, &StatedErrors::double_error)),
      fmt::arg("f", largest(bounds.models, &StatedErrors::float_of_peak)),
      fmt::arg("alpha", sharpest_float_roughness), fmt::arg("exponent", sharpest_float_exponent));
}

/// The names of the models that a condition is that of.
std::string names_under(std::string_view condition, std::span<const ModelErrors> models) {
  std::string names;
  for (const ModelErrors& model : models) {
    if (model.condition != condition) continue;
    fmt::format_to(std::back_inserter(names), "{}`{}`", names.empty() ? "" : ", ", model.name);
  }
  return names;
}

std::string exceptions(std::span<const ModelErrors> models) {
  std::string text = "Excepted from both bounds, and held to this one instead:\n\n";
  std::vector<std::string_view> listed{""};
  for (const ModelErrors& model : models) {
    if (std::find(listed.begin(), listed.end(), model.condition) != listed.end()) continue;
    listed.push_back(model.condition);
    fmt::format_to(std::back_inserter(text), "- {}:\n  {}.\n", names_under(model.condition, models),
                   model.condition);
  }
  return text + R"(
epsilon is 2.2e-16 in double and 1.2e-7 in float. Where r.wo is no larger than 2 epsilon its very sign
is unknown: the value may be 0. This is more than 1e-11 in double for exponents n below 3.2 only, and
more than 2e-6 of the peak in float for exponents below 1 only: sharper lobes are dark there.

)";
}

std::string model_table(std::span<const ModelErrors> models, const PageBounds& bounds) {
  std::string text =
      R"(## By model

A plus sign marks the specular part alone, beside another diffuse term. "Textbook" is the formula as
it is printed, with acos and tan, powers of cosines, normalised vectors, in the same precision and for
the same input: it errs by at least so much somewhere, where a 1 stands for a value that is all wrong
or no number. A dash: it does well.

| model | double: relative error at most | float: of the peak at most | textbook, double | textbook, float | parameters |
|---|---|---|---|---|---|
)";
  for (std::size_t m = 0; m < bounds.models.size(); ++m) {
    text += row(bounds.models[m], parameter_ranges(models[m]));
  }
  return text;
}

std::string region_table(const PageBounds& bounds) {
  std::string text =
      R"(
## By region

The worst of all models.

| region | double: relative error at most | float: of the peak at most | textbook, double | textbook, float | what it is |
|---|---|---|---|---|---|
)";
  for (std::size_t r = 0; r < bounds.regions.size(); ++r) {
    text += row(bounds.regions[r], regions()[r].meaning);
  }
  return text;
}

constexpr std::string_view method = R"(
## How it is measured

Parameters are drawn on their bounds, within 1e-7 of them and inside; those of an anisotropic lobe
differ by up to the whole range. The truth is the published formula in 50 digits, written apart from
the models' code. Half-vector lobes are compared for the same rounded components; mirror lobes for
the normalised directions, whose norms an exponent of 1e6 would show. The peak is the largest f_r
for the same light over its viewers, or that of a light at 45 deg times its cosine where that is
larger: never more than the peak over all directions, so that no value that counts is left out.
)";

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::optional<double> bound_from(std::string_view text) {
  if (text == "-") return 0;
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The bounds of the row that a subject has in the page's tables, if it has one.
std::optional<StatedErrors> read_row(std::string_view line, const std::string& subject) {
  const std::string start = "| " + subject + " | ";
  if (line.substr(0, start.size()) != start) return std::nullopt;
  line.remove_prefix(start.size());
  std::array<double, 4> values{};
  for (double& value : values) {
    const std::size_t end = line.find(" | ");
    if (end == std::string_view::npos) return std::nullopt;
    const std::optional<double> bound = bound_from(line.substr(0, end));
    if (!bound) return std::nullopt;
    value = *bound;
    line.remove_prefix(end + 3);
  }
  return StatedErrors{subject, values[0], values[1], values[2], values[3]};
}

std::optional<StatedErrors> find_row(std::span<const std::string_view> lines,
                                     const std::string& subject) {
  for (const std::string_view line : lines) {
    if (auto found = read_row(line, subject)) return found;
  }
  return std::nullopt;
}

/// Compares one number of the page with what was measured.
class Comparison {
 public:
  Comparison(std::string subject, std::vector<std::string>& faults)
      : subject_(std::move(subject)), faults_(faults) {}

  void at_most(std::string_view what, double stated, double measured, double floor) {
    if (measured > stated || stated > std::max(widest * measured, 2 * floor)) {
      report(what, stated, measured);
    }
  }
  void at_least(std::string_view what, double stated, double measured) {
    if (measured < stated) report(what, stated, measured);
  }

 private:
  void report(std::string_view what, double stated, double measured) {
    faults_.push_back(
        fmt::format("{}: {}: {:.0e} stated, {:.1e} measured", subject_, what, stated, measured));
  }

  std::string subject_;
  std::vector<std::string>& faults_;
};

/// The page's bounds, of which each is compared with what was measured.
std::vector<StatedErrors> compared(std::span<const std::string_view> lines,
                                   std::span<const StatedErrors> measured,
                                   std::vector<std::string>& faults) {
  std::vector<StatedErrors> bounds;
  for (const StatedErrors& m : measured) {
    const std::optional<StatedErrors> stated = find_row(lines, m.subject);
    if (!stated) {
      faults.push_back(fmt::format("{}: a row with four bounds is missing", m.subject));
      continue;
    }
    Comparison compare(m.subject, faults);
    compare.at_most("double", stated->double_error, m.double_error, double_floor);
    compare.at_most("float", stated->float_of_peak, m.float_of_peak, float_floor);
    compare.at_least("textbook, double", stated->naive_double_error, m.naive_double_error);
    compare.at_least("textbook, float", stated->naive_float_of_peak, m.naive_float_of_peak);
    bounds.push_back(*stated);
  }
  return bounds;
}

/// The first line in which both differ.
std::string first_difference(const std::string& found, const std::string& expected) {
  const auto a = lines_of(found);
  const auto b = lines_of(expected);
  std::size_t line = 0;
  while (line < a.size() && line < b.size() && a[line] == b[line]) ++line;
  return fmt::format("line {}: found '{}', expected '{}'", line + 1, line < a.size() ? a[line] : "",
                     line < b.size() ? b[line] : "");
}

}  // namespace

PageBounds stated_bounds(std::span<const ModelErrors> models) {
  PageBounds bounds = measured_errors(models);
  for (std::vector<StatedErrors>* list : {&bounds.models, &bounds.regions}) {
    for (StatedErrors& e : *list) {
      e.double_error = upper_bound(e.double_error, double_floor, double_figure);
      e.float_of_peak = upper_bound(e.float_of_peak, float_floor, float_figure);
      e.naive_double_error = lower_bound(e.naive_double_error, e.double_error);
      e.naive_float_of_peak = lower_bound(e.naive_float_of_peak, e.float_of_peak);
    }
  }
  return bounds;
}

std::string page_text(std::span<const ModelErrors> models, const PageBounds& bounds) {
  return introduction(bounds) + exceptions(models) + model_table(models, bounds) +
         region_table(bounds) + std::string(method);
}

std::vector<std::string> faults_of_text(const std::string& text,
                                        std::span<const ModelErrors> models) {
  std::vector<std::string> faults;
  const std::vector<std::string_view> lines = lines_of(text);
  const PageBounds measured = measured_errors(models);
  const PageBounds stated{compared(lines, measured.models, faults),
                          compared(lines, measured.regions, faults)};
  if (!faults.empty()) return faults;
  const std::string expected = page_text(models, stated);
  if (text != expected) faults.push_back(first_difference(text, expected));
  return faults;
}

std::vector<std::string> faults_of_page(const std::string& path,
                                        std::span<const ModelErrors> models) {
  const table::InputFile file(path);
  std::vector<std::string> faults = faults_of_text(std::string(file.bytes()), models);
  for (std::string& fault : faults) fault = path + ": " + fault;
  return faults;
}

}  // namespace gonio::bench
