#include "apps/gonio/fit_batch.h"

#include <exception>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include "apps/gonio/fit_messages.h"
#include "apps/gonio/fit_summary.h"
#include "table/output_file.h"

namespace gonio::app {
namespace {

/// What remains of a table once it is fitted.
struct TableOutcome {
  TableSummary summary;
  nlohmann::ordered_json json = {};  // null unless it is asked for
  bool is_wrong_usage = false;       // options that do not fit this table
};

TableOutcome outcome_of(const TableFit& table_fit, const std::string& table, bool as_json) {
  TableOutcome outcome{.summary = summary_of(table_fit)};
  if (as_json) outcome.json = {{"table", table}, {"fits", json_of_fits(table_fit)}};
  return outcome;
}

/// Reports the error, which names the table in any case.
TableOutcome failed(const std::string& table, const std::string& problem, FitMessages& messages) {
  const std::string error = problem.starts_with(table + ":") ? problem : table + ": " + problem;
  messages.error(error);
  return {{.table = table, .error = error}, {{"table", table}, {"error", error}}, false};
}

TableOutcome run_one(const FitRequest& request, const FitFiles& files, bool as_json,
                     FitMessages& messages) {
  try {
    const TableFit table_fit = fit_table(request, files, messages);
    note_warnings(table_fit, messages);
    return outcome_of(table_fit, files.table, as_json);
  } catch (const std::bad_alloc&) {
    return failed(files.table, "out of memory", messages);
  } catch (const std::invalid_argument& error) {
    TableOutcome outcome = failed(files.table, error.what(), messages);
    outcome.is_wrong_usage = true;
    return outcome;
  } catch (const std::exception& error) {
    return failed(files.table, error.what(), messages);
  }
}

}  // namespace

void run_batch(const FitRequest& request, const FitPlan& plan, const FitArguments& arguments,
               Invocation& invocation) {
  std::vector<TableSummary> summaries;
  nlohmann::ordered_json json;
  FitMessages messages;
  bool all_wrong_usage = true;
  for (const FitFiles& files : plan.tables) {
    messages.begin_table(files.table, summaries.size() + 1, plan.tables.size());
    TableOutcome outcome = run_one(request, files, arguments.json, messages);
    if (!outcome.summary.is_good()) invocation.exit_status = 1;
    all_wrong_usage = all_wrong_usage && outcome.is_wrong_usage;
    if (arguments.json) json["tables"].push_back(std::move(outcome.json));
    summaries.push_back(std::move(outcome.summary));
  }
  messages.clear();
  // What no table can be fitted with is no fault of the tables.
  if (all_wrong_usage) invocation.exit_status = 2;

  if (!plan.summary.empty()) table::write_file(plan.summary, summary_csv(summaries));
  if (arguments.json) {
    print_json(json);
  } else if (arguments.summary && plan.summary.empty()) {
    print(summary_csv(summaries));
  } else {
    print(summary_text(summaries, request.options));
  }
}

}  // namespace gonio::app
