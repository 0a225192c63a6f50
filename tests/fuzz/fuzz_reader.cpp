// libFuzzer target of one reader, GONIO_FORMAT: whatever the bytes are, a table or a FileError
// comes of them. Built once per format; scripts/fuzz runs them.
#include <sanitizer/allocator_interface.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "table/describe.h"
#include "table/file_error.h"
#include "table/formats/astm.h"
#include "table/formats/curet.h"
#include "table/formats/exr_table.h"
#include "table/formats/foreign_csv.h"
#include "table/formats/gonio_csv.h"
#include "table/formats/klems.h"
#include "table/formats/merl.h"
#include "table/formats/openmaterial.h"
#include "table/formats/rgl.h"
#include "table/formats/zemax.h"

namespace {

using gonio::table::MaskReason;
using gonio::table::ReadOptions;
using gonio::table::SampleTable;

constexpr std::string_view fuzzed_format = GONIO_FORMAT;
/// No piece of memory may be larger than this many times the input, or than the floor. In an image
/// zlib expands by up to 1032, and OpenEXR has room for 16 lines though there may be one.
constexpr std::size_t most_memory_per_byte = fuzzed_format == "exr" ? 17 * 1040 : 10;
constexpr std::size_t memory_floor = std::size_t{1} << 20;
std::atomic<std::size_t> memory_limit{0};

void check_allocation(const volatile void* /*memory*/, std::size_t size) {
  const std::size_t limit = memory_limit.load();
  if (limit == 0 || size <= limit) return;
  memory_limit = 0;  // what reports it allocates too
  std::fprintf(stderr, "an allocation of %zu bytes, the limit is %zu\n", size, limit);
  std::abort();
}

void ignore_release(const volatile void* /*memory*/) {}

/// CUReT's two files in one input, a line of '=' between them.
SampleTable read_pair(std::string_view content, const ReadOptions& options) {
  static const std::string folder =
      (std::filesystem::temp_directory_path() / ("gonio_fuzz_" + std::to_string(getpid())))
          .string();
  std::filesystem::create_directories(folder);
  const std::size_t border = content.find("\n=\n");
  const std::string_view first = content.substr(0, border);
  const std::string_view second =
      border == std::string_view::npos ? std::string_view() : content.substr(border + 3);
  const std::string path = folder + "/abrdf.dat";
  std::ofstream(folder + "/table.txt", std::ios::binary) << second;
  std::ofstream(path, std::ios::binary) << first;
  return gonio::table::read_curet_file(first, path, options);
}

ReadOptions options_of_foreign_csv() {
  ReadOptions options;
  options.quantity = gonio::table::Quantity::brdf_cos;
  options.angles = gonio::table::AngleUnit::degrees;
  return options;
}

SampleTable read(std::string_view content) {
  using namespace gonio::table;  // NOLINT(google-build-using-namespace)
  constexpr std::string_view format = fuzzed_format;
  ReadOptions options;
  options.threads = 1;
  if (format == "gonio_csv") return read_gonio_csv(content, "input", options);
  if (format == "foreign_csv") return read_foreign_csv(content, "input", options_of_foreign_csv());
  if (format == "astm") return read_astm(content, "input", options);
  if (format == "merl") return read_merl(content, "input", options);
  if (format == "rgl") return read_rgl(content, "input", options);
  if (format == "zemax") return read_zemax(content, "input", options);
  if (format == "klems") return read_klems(content, "input", options);
  if (format == "exr") return read_exr_table(content, "input", options);
  if (format == "openmaterial") return read_openmaterial(content, "input", options);
  options.material = 1;
  return read_pair(content, options);
}

/// Formats that can be evaluated between their samples.
void evaluate_grid(std::string_view content) {
  using namespace gonio::table;  // NOLINT(google-build-using-namespace)
  constexpr std::string_view format = fuzzed_format;
  GriddedTable grid;
  if (format == "merl") grid = read_merl_grid(content, "input");
  if (format == "rgl") grid = read_rgl_grid(content, "input");
  if (format == "zemax") grid = read_zemax_grid(content, "input");
  if (format == "klems") grid = read_klems_grid(content, "input");
  if (format == "openmaterial") grid = read_openmaterial_grid(content, "input");
  if (!grid.f_r) return;
  std::vector<double> f_r(grid.channels.size());
  for (const double theta : {0.0, 20.0, 47.0, 89.0, 90.0}) {
    for (const double phi : {0.0, 100.0, 180.0, 301.0}) {
      grid.f_r(gonio::brdf::direction_from_degrees(theta, 0),
               gonio::brdf::direction_from_degrees(90 - theta, phi), f_r);
      for (const double value : f_r) {
        if (std::isinf(value)) std::abort();
      }
    }
  }
}

bool is_unit(const gonio::brdf::Direction<double>& d) {
  return std::abs(d.x * d.x + d.y * d.y + d.z * d.z - 1) < 1e-9;
}

/// What a reader promises of every table.
void check(const SampleTable& table) {
  const std::size_t count = table.size();
  const auto require = [](bool holds) {
    if (!holds) std::abort();
  };
  require(count > 0 && !table.channels.empty());
  require(table.wi.size() == count && table.wo.size() == count);
  require(table.values.size() == table.channels.size());
  require(table.sigma.empty() || table.sigma.size() == table.channels.size());
  require(table.weight.empty() || table.weight.size() == count);
  for (std::size_t i = 0; i < count; ++i) {
    require(is_unit(table.wi[i]) && is_unit(table.wo[i]));
    require(table.weight.empty() || (std::isfinite(table.weight[i]) && table.weight[i] >= 0));
  }
  for (const auto& values : table.values) {
    require(values.size() == count);
    for (const double value : values) require(!std::isinf(value));
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  __sanitizer_install_malloc_and_free_hooks(check_allocation, ignore_release);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  memory_limit = std::max(memory_floor, most_memory_per_byte * size);
  try {
    const SampleTable table = read(content);
    memory_limit = 0;
    check(table);
    gonio::table::describe(table);
  } catch (const gonio::table::FileError&) {
  }
  memory_limit = std::max(memory_floor, most_memory_per_byte * size);
  try {
    evaluate_grid(content);
  } catch (const gonio::table::FileError&) {
  }
  memory_limit = 0;
  return 0;
}
