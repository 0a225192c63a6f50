#include "apps/gonio/fit_plan.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "table/file_error.h"
#include "table/output_file.h"

namespace gonio::app {
namespace {

namespace fs = std::filesystem;

struct Output {
  std::string_view option;
  std::string path;
};

std::vector<Output> outputs_of(const FitPlan& plan) {
  std::vector<Output> outputs;
  const auto add = [&](std::string_view option, const std::string& path) {
    if (!path.empty()) outputs.push_back({option, path});
  };
  for (const FitFiles& files : plan.tables) {
    add("-o", files.material);
    add("--residuals", files.residuals);
  }
  add("--summary", plan.summary);
  return outputs;
}

bool names_a_folder(const std::string& path) {
  std::error_code error;
  return path.ends_with('/') || fs::is_directory(path, error);
}

/// Equal for two paths that lead to one file, which may not exist yet.
std::string identity_of(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) return fmt::format("{}:{}", status.st_dev, status.st_ino);
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal().string() : canonical.string();
}

/// Throws if two tables would write to one name.
void check_names(const std::vector<std::string>& tables) {
  std::map<std::string, std::string> table_of;
  for (const std::string& table : tables) {
    const std::string name = fs::path(table).stem().string();
    const auto [first, is_new] = table_of.emplace(name, table);
    if (!is_new) {
      throw std::invalid_argument(
          fmt::format("{} and {}: both would be written as '{}': rename one, or fit them apart",
                      first->second, table, name));
    }
  }
}

/// Throws for an output that would destroy a table or another output.
void check_overwriting(const FitPlan& plan) {
  const std::string_view another = plan.is_batch ? "folder" : "file";
  std::map<std::string, std::string> table_of;
  for (const FitFiles& files : plan.tables) table_of.emplace(identity_of(files.table), files.table);
  std::map<std::string, std::string_view> option_of;
  for (const auto& [option, path] : outputs_of(plan)) {
    const std::string identity = identity_of(path);
    if (table_of.contains(identity)) {
      throw std::invalid_argument(
          fmt::format("{} {}: would overwrite the table: name another {}", option, path, another));
    }
    const auto [first, is_new] = option_of.emplace(identity, option);
    if (!is_new) {
      throw std::invalid_argument(fmt::format("{} {}: is the file of {} as well: name another {}",
                                              option, path, first->second, another));
    }
  }
}

FitPlan batch_in(const FitArguments& arguments) {
  if (arguments.summary && arguments.json && arguments.output.empty()) {
    throw std::invalid_argument(
        "--summary and --json would both go to stdout: add -o FOLDER, which gets the summary, or "
        "leave one of them out");
  }
  if (!arguments.output.empty() || !arguments.residuals.empty()) check_names(arguments.tables);
  const auto within = [](const std::string& folder, const std::string& name) {
    return folder.empty() ? std::string() : (fs::path(folder) / name).string();
  };
  FitPlan plan{.is_batch = true, .tables = {}, .summary = {}};
  for (const std::string& table : arguments.tables) {
    const std::string name = fs::path(table).stem().string();
    plan.tables.push_back({table, within(arguments.output, name + ".json"),
                           within(arguments.residuals, name + ".csv")});
  }
  if (arguments.summary) plan.summary = within(arguments.output, "summary.csv");
  return plan;
}

FitPlan single_in(const FitArguments& arguments) {
  return {.is_batch = false,
          .tables = {{arguments.tables.front(), arguments.output, arguments.residuals}},
          .summary = {}};
}

void create_folder(std::string_view option, const std::string& folder) {
  if (folder.empty()) return;
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    throw std::invalid_argument(
        fmt::format("{} {}: is no folder, but several tables or --summary need one: name a folder",
                    option, folder));
  }
  fs::create_directories(folder, error);
  if (error) {
    throw table::FileError(
        fmt::format("{}: the folder cannot be created ({}): check the path and what you may write",
                    folder, error.message()));
  }
}

}  // namespace

FitPlan plan_in(const FitArguments& arguments) {
  const bool is_batch =
      arguments.tables.size() > 1 || arguments.summary || names_a_folder(arguments.output);
  FitPlan plan = is_batch ? batch_in(arguments) : single_in(arguments);
  check_overwriting(plan);
  return plan;
}

void prepare_outputs(const FitArguments& arguments, const FitPlan& plan) {
  if (plan.is_batch) {
    create_folder("-o", arguments.output);
    create_folder("--residuals", arguments.residuals);
  }
  for (const Output& output : outputs_of(plan)) const table::OutputFile probe(output.path);
}

}  // namespace gonio::app
