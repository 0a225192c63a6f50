// gonio fit: from a table to parameters with error bars.
#include <fmt/format.h>

#include <memory>
#include <utility>
#include <vector>

#include "apps/gonio/command.h"
#include "apps/gonio/fit_arguments.h"
#include "apps/gonio/fit_batch.h"
#include "apps/gonio/fit_messages.h"
#include "apps/gonio/fit_plan.h"
#include "apps/gonio/fit_report.h"
#include "apps/gonio/fit_table.h"

namespace gonio::app {
namespace {

/// One model: its material; several: a list, best first.
void print_json_of(const TableFit& table_fit, bool is_single_model) {
  nlohmann::ordered_json fits = json_of_fits(table_fit);
  if (is_single_model) {
    print_json(fits.front());
    return;
  }
  nlohmann::ordered_json all;
  all["fits"] = std::move(fits);
  print_json(all);
}

void print_report_of(const TableFit& table_fit, const fit::Options& options) {
  const fit::FitResult& best = table_fit.fits.front().result;
  print(report_table(table_fit.table, best, options.max_theta_deg));
  if (table_fit.fits.size() > 1) {
    std::vector<fit::FitResult> results;
    for (const ModelFit& fit : table_fit.fits) results.push_back(fit.result);
    print(report_ranking(results));
  }
  print(report_fit(best, options));
}

void run_table(const FitRequest& request, const FitFiles& files, bool as_json,
               Invocation& invocation) {
  FitMessages messages;
  messages.begin_table(files.table, 1, 1);
  const TableFit table_fit = fit_table(request, files, messages);
  messages.clear();
  if (as_json) {
    print_json_of(table_fit, request.models && request.models->size() == 1);
  } else {
    print_report_of(table_fit, request.options);
  }
  note_warnings(table_fit, messages);
  if (!table_fit.has_converged()) invocation.exit_status = 1;
}

void run_fit(const FitArguments& arguments, Invocation& invocation) {
  const FitRequest request{.options = options_in(arguments),
                           .reading = arguments.reading,
                           .models = models_in(arguments),
                           .frame = frame_in(arguments),
                           .command_line = invocation.command_line,
                           .with_digest = arguments.json || !arguments.output.empty()};
  const FitPlan plan = plan_in(arguments);
  prepare_outputs(arguments, plan);
  if (plan.is_batch) {
    run_batch(request, plan, arguments, invocation);
  } else {
    run_table(request, plan.tables.front(), arguments.json, invocation);
  }
}

}  // namespace

void add_fit_command(CLI::App& app, Invocation& invocation) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::App* command = app.add_subcommand(
      "fit", "Fit models to a table: parameters with standard deviations and 95 % intervals");
  command
      ->add_option("TABLE", arguments->tables,
                   "the measured table, in any format; several are a batch")
      ->required();
  add_table_options(*command, arguments->reading);
  command
      ->add_option("-m,--model", arguments->models,
                   "MODEL[,MODEL..] (see gonio models), or all; without it, all the models "
                   "that this table can determine")
      ->type_name("MODEL");
  command
      ->add_option("--metric", arguments->metric,
                   "what is minimised: l2, cosine-l2, log, cube-root, relative or chi2")
      ->capture_default_str()
      ->type_name("METRIC");
  command
      ->add_option("--loss", arguments->loss,
                   "how much outliers count: none (as squares), huber, cauchy or tukey")
      ->capture_default_str()
      ->type_name("LOSS");
  command
      ->add_option(
          "--loss-scale", arguments->loss_scale,
          "the residual from which on the loss doubts it, in the metric's unit; found from "
          "the residuals if not given")
      ->type_name("X");
  command
      ->add_option("--noise", arguments->noise,
                   "for chi2: sigma^2 = (REL f)^2 + ABS^2, instead of the table's sigma")
      ->type_name("REL,ABS");
  command
      ->add_option("--max-theta", arguments->max_theta,
                   "leave out samples with a polar angle beyond it, in degrees")
      ->capture_default_str()
      ->type_name("DEG");
  command->add_option("--fix", arguments->fixed, "hold a parameter, e.g. alpha=0.1 or rho_d.R=0.2")
      ->allow_extra_args(false)
      ->type_name("P=V");
  command->add_option("--bounds", arguments->bounds, "confine a parameter, e.g. alpha=0.01:0.5")
      ->allow_extra_args(false)
      ->type_name("P=LO:HI");
  command
      ->add_option("--start", arguments->start,
                   "start a shape parameter there as well as where the search finds")
      ->allow_extra_args(false)
      ->type_name("P=V");
  command->add_flag("--free-frame", arguments->free_frame,
                    "find the tangent angle psi of anisotropic lobes, too");
  command->add_flag("--homogeneous", arguments->homogeneous, "rho_s = 1 - rho_d in every channel");
  command
      ->add_option("--covariance", arguments->covariance, "auto, known-sigma, residual or sandwich")
      ->capture_default_str()
      ->type_name("KIND");
  command->add_option("--threads", arguments->threads, "0: all; the result is the same for any")
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option(
          "-o,--output", arguments->output,
          "write the (best) material as JSON; in a batch a folder that gets NAME.json for each "
          "table")
      ->type_name("FILE");
  command
      ->add_option("--residuals", arguments->residuals,
                   "write the table with the (best) model's values and the residuals; in a batch a "
                   "folder")
      ->type_name("CSV");
  command->add_flag(
      "--summary", arguments->summary,
      "every model of every table as CSV: summary.csv in the folder of -o, or stdout");
  command->add_flag("--json", arguments->json, "print the result as JSON");
  command->callback([arguments, &invocation] { run_fit(*arguments, invocation); });
}

}  // namespace gonio::app
