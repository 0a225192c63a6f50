// gonio fit for several tables: each on its own, past those that fail, and a summary of all.
#pragma once

#include "apps/gonio/command.h"
#include "apps/gonio/fit_arguments.h"
#include "apps/gonio/fit_plan.h"
#include "apps/gonio/fit_table.h"

namespace gonio::app {

/// Fits the tables of the plan one after the other; only one is in memory at a time. A table that
/// fails is reported on stderr and listed. Sets exit status 1 if one failed or a fit did not
/// converge.
void run_batch(const FitRequest& request, const FitPlan& plan, const FitArguments& arguments,
               Invocation& invocation);

}  // namespace gonio::app
