#include "material/fit_summary_json.h"

#include <fmt/format.h>

#include <limits>
#include <string_view>

namespace gonio::material {
namespace {

using nlohmann::ordered_json;
using table::JsonField;

// Reading ------------------------------------------------------------------------------------

std::vector<std::vector<std::optional<double>>> read_correlation(const JsonField& field,
                                                                 std::size_t count) {
  std::vector<std::vector<std::optional<double>>> rows;
  for (const JsonField& row : field.elements()) {
    rows.emplace_back();
    for (const JsonField& entry : row.elements()) {
      rows.back().push_back(entry.is_null() ? std::nullopt : std::optional(entry.number()));
    }
    if (rows.back().size() != count) row.expected(fmt::format("a row of {}", count));
  }
  if (rows.size() != count) {
    field.expected(fmt::format("{} rows, one per entry of correlation_parameters", count));
  }
  return rows;
}

int read_iterations(const JsonField& field) {
  const std::uint64_t count = field.whole_number();
  if (count > std::numeric_limits<int>::max()) field.expected("a number of iterations");
  return static_cast<int>(count);
}

double read_positive(const JsonField& field) {
  const double value = field.number();
  if (!(value > 0)) field.expected("a number above 0");
  return value;
}

double read_probability(const JsonField& field) {
  const double value = field.number();
  if (!(value >= 0 && value <= 1)) field.expected("a probability, 0 to 1");
  return value;
}

double read_error(const JsonField& field) {
  const double value = field.number();
  if (!(value >= 0)) field.expected("a root mean square, 0 or more");
  return value;
}

std::vector<std::pair<std::string, double>> read_errors(const JsonField& field) {
  std::vector<std::pair<std::string, double>> errors;
  for (const auto& [name, value] : field.members()) errors.emplace_back(name, read_error(value));
  return errors;
}

Outliers read_outliers(const JsonField& field) {
  Outliers outliers{.threshold = read_positive(field.member("threshold")),
                    .count = field.member("count").whole_number(),
                    .listed = {}};
  const JsonField listed = field.member("listed");
  for (const JsonField& entry : listed.elements()) {
    outliers.listed.push_back({.sample = entry.member("sample").whole_number(),
                               .channel = entry.member("channel").text(),
                               .residual = entry.member("residual").number()});
  }
  if (outliers.listed.size() > Outliers::most_listed) {
    listed.expected(fmt::format("at most the {} largest outliers", Outliers::most_listed));
  }
  if (outliers.listed.size() > outliers.count) {
    listed.expected(fmt::format("at most count = {} outliers", outliers.count));
  }
  return outliers;
}

std::pair<double, double> read_angle_range(const JsonField& field) {
  const std::vector<double> ends = field.numbers();
  if (ends.size() != 2 || !(0 <= ends[0] && ends[0] <= ends[1] && ends[1] <= 90)) {
    field.expected("[lowest, highest] incidence angle in degrees, within 0 to 90");
  }
  return {ends[0], ends[1]};
}

HeldOut read_held_out(const JsonField& field) {
  HeldOut held_out{.errors = read_errors(field.member("errors")), .folds = {}};
  for (const JsonField& fold : field.member("folds").elements()) {
    held_out.folds.push_back({.theta_i_deg = read_angle_range(fold.member("theta_i_deg")),
                              .values = fold.member("values").whole_number(),
                              .error = read_error(fold.member("error"))});
  }
  return held_out;
}

NestedComparison read_nested(const JsonField& field) {
  return {.in = field.member("in").text(),
          .test = field.member("test").text(),
          .statistic = field.member("statistic").number(),
          .p_value = read_probability(field.member("p_value")),
          .text = field.member("text").text()};
}

// Writing ------------------------------------------------------------------------------------

ordered_json json_of(const std::vector<std::pair<std::string, double>>& errors) {
  ordered_json json = ordered_json::object();
  for (const auto& [metric, error] : errors) json[metric] = error;
  return json;
}

ordered_json json_of(const std::vector<std::vector<std::optional<double>>>& correlation) {
  ordered_json rows = ordered_json::array();
  for (const auto& row : correlation) {
    rows.push_back(ordered_json::array());
    for (const auto& entry : row) rows.back().push_back(entry ? ordered_json(*entry) : nullptr);
  }
  return rows;
}

ordered_json json_of(const Outliers& outliers) {
  ordered_json listed = ordered_json::array();
  for (const Outlier& outlier : outliers.listed) {
    listed.push_back(
        {{"sample", outlier.sample}, {"channel", outlier.channel}, {"residual", outlier.residual}});
  }
  return {{"threshold", outliers.threshold}, {"count", outliers.count}, {"listed", listed}};
}

ordered_json json_of(const HeldOut& held_out) {
  ordered_json folds = ordered_json::array();
  for (const HeldOutFold& fold : held_out.folds) {
    folds.push_back(
        {{"theta_i_deg", fold.theta_i_deg}, {"values", fold.values}, {"error", fold.error}});
  }
  return {{"errors", json_of(held_out.errors)}, {"folds", folds}};
}

ordered_json json_of(const NestedComparison& nested) {
  return {{"in", nested.in},
          {"test", nested.test},
          {"statistic", nested.statistic},
          {"p_value", nested.p_value},
          {"text", nested.text}};
}

}  // namespace

FitSummary read_fit_summary(const JsonField& field) {
  FitSummary fit;
  if (const auto f = field.find("metric")) fit.metric = f->text();
  if (const auto f = field.find("loss")) fit.loss = f->text();
  if (const auto f = field.find("loss_scale")) fit.loss_scale = read_positive(*f);
  if (const auto f = field.find("covariance")) fit.covariance = f->text();
  if (const auto f = field.find("samples")) fit.samples = f->whole_number();
  if (const auto f = field.find("used")) fit.used = f->whole_number();
  if (const auto f = field.find("converged")) fit.converged = f->flag();
  if (const auto f = field.find("iterations")) fit.iterations = read_iterations(*f);
  if (const auto f = field.find("errors")) fit.errors = read_errors(*f);
  if (const auto f = field.find("held_out")) fit.held_out = read_held_out(*f);
  if (const auto f = field.find("reduced_chi2")) fit.reduced_chi2 = f->number();
  if (const auto f = field.find("aicc")) fit.aicc = f->number();
  if (const auto f = field.find("bic")) fit.bic = f->number();
  if (const auto f = field.find("nested")) fit.nested = read_nested(*f);
  if (const auto f = field.find("outliers")) fit.outliers = read_outliers(*f);
  if (const auto f = field.find("correlation_parameters")) fit.correlation_parameters = f->texts();
  if (const auto f = field.find("correlation")) {
    fit.correlation = read_correlation(*f, fit.correlation_parameters.size());
  }
  if (const auto f = field.find("warnings")) fit.warnings = f->texts();
  return fit;
}

ordered_json json_of(const FitSummary& fit) {
  ordered_json json;
  json["metric"] = fit.metric;
  json["loss"] = fit.loss;
  if (fit.loss_scale) json["loss_scale"] = *fit.loss_scale;
  json["covariance"] = fit.covariance;
  json["samples"] = fit.samples;
  json["used"] = fit.used;
  json["converged"] = fit.converged;
  json["iterations"] = fit.iterations;
  json["errors"] = json_of(fit.errors);
  if (fit.held_out) json["held_out"] = json_of(*fit.held_out);
  if (fit.reduced_chi2) json["reduced_chi2"] = *fit.reduced_chi2;
  if (fit.aicc) json["aicc"] = *fit.aicc;
  if (fit.bic) json["bic"] = *fit.bic;
  if (fit.nested) json["nested"] = json_of(*fit.nested);
  if (fit.outliers) json["outliers"] = json_of(*fit.outliers);
  json["correlation_parameters"] = fit.correlation_parameters;
  json["correlation"] = json_of(fit.correlation);
  json["warnings"] = fit.warnings;
  return json;
}

}  // namespace gonio::material
