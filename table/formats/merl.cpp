#include "table/formats/merl.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "table/file_error.h"
#include "table/formats/merl_grid.h"
#include "table/parallel.h"

namespace gonio::table {

namespace {

static_assert(std::endian::native == std::endian::little, "the file's bytes are read as they are");

constexpr double horizon_tolerance = 1e-6 * std::numbers::pi / 180;
constexpr double hole = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t header_size = 3 * sizeof(std::int32_t);
constexpr std::size_t channel_count = merl_channels.size();
constexpr std::size_t bytes_per_bin = channel_count * sizeof(double);

// The file ----------------------------------------------------------------------------------------

using Sizes = std::array<std::int32_t, 3>;
constexpr Sizes sizes_of_merl{90, 90, 180};

std::optional<Sizes> sizes_in(std::string_view content) {
  if (content.size() < header_size) return std::nullopt;
  Sizes sizes{};
  std::memcpy(sizes.data(), content.data(), header_size);
  return sizes;
}

/// The bytes of a file with these sizes; nothing if a size is not positive or there are too many.
std::optional<std::size_t> file_size(const Sizes& sizes) {
  std::size_t bins = 1;
  for (const std::int32_t size : sizes) {
    if (size < 1) return std::nullopt;
    const auto count = static_cast<std::size_t>(size);
    constexpr std::size_t most = std::numeric_limits<std::size_t>::max() / 2 / bytes_per_bin;
    if (bins > most / count) return std::nullopt;
    bins *= count;
  }
  return header_size + bins * bytes_per_bin;
}

/// The values of a file; refers to its bytes.
struct MerlFile {
  MerlGrid grid;
  const char* values = nullptr;
  std::size_t trailing_bytes = 0;

  double value(std::size_t channel, std::size_t bin) const {
    double result = 0;
    std::memcpy(&result, values + (channel * grid.bins() + bin) * sizeof result, sizeof result);
    return result;
  }
};

MerlFile open(std::string_view content, const std::string& path) {
  const std::optional<Sizes> sizes = sizes_in(content);
  if (!sizes) {
    throw FileError(
        fmt::format("{}: {} bytes, expected the 12 bytes of three sizes: name a file "
                    "of MERL's format",
                    path, content.size()));
  }
  const std::string product = fmt::format("{} x {} x {}", (*sizes)[0], (*sizes)[1], (*sizes)[2]);
  const std::optional<std::size_t> expected = file_size(*sizes);
  if (!expected) {
    throw FileError(
        fmt::format("{}: byte 0: sizes of theta_h, theta_d, phi_d are {}, which no file can hold, "
                    "expected 90 x 90 x 180: the file is broken or of another format",
                    path, product));
  }
  if (content.size() < *expected) {
    throw FileError(
        fmt::format("{}: the file ends at byte {}, expected {} bytes for {} bins of R, "
                    "G and B: get it again, it is not complete",
                    path, content.size(), *expected, product));
  }
  const auto count = [&](std::size_t i) { return static_cast<std::size_t>((*sizes)[i]); };
  return {.grid = {.theta_h_count = count(0), .theta_d_count = count(1), .phi_d_count = count(2)},
          .values = content.data() + header_size,
          .trailing_bytes = content.size() - *expected};
}

std::vector<std::string> notes_on(const MerlFile& file) {
  if (file.trailing_bytes == 0) return {};
  return {fmt::format("{} bytes behind the last bin were passed over", file.trailing_bytes)};
}

std::vector<std::string> channel_names() { return {merl_channels.begin(), merl_channels.end()}; }

Provenance provenance_of(const std::string& path) {
  return {.path = path,
          .format = "MERL",
          .sha256 = {},
          .quantity = Quantity::brdf,
          .angles = AngleUnit::radians};
}

/// The file itself does not say what it holds.
std::string name_from(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

[[noreturn]] void fail_for_value(const MerlFile& file, const std::string& path, std::size_t channel,
                                 std::size_t bin) {
  const MerlGrid& grid = file.grid;
  const std::size_t row = bin / grid.phi_d_count;
  throw FileError(fmt::format(
      "{}: channel {}, bin {} (theta_h {}, theta_d {}, phi_d {}): found {}, expected a finite "
      "number: write -1 where nothing was measured",
      path, merl_channels[channel], bin, row / grid.theta_d_count, row % grid.theta_d_count,
      bin % grid.phi_d_count, file.value(channel, bin)));
}

// Work by rows of one theta_h and theta_d, many of them a task ------------------------------------

struct Rows {
  std::size_t begin, end;
};

template <class Task>
void for_rows(const MerlGrid& grid, int threads, const Task& task) {
  const std::size_t rows = grid.theta_h_count * grid.theta_d_count;
  const std::size_t rows_per_task = std::max<std::size_t>(1, 8192 / grid.phi_d_count);
  const std::size_t tasks = (rows + rows_per_task - 1) / rows_per_task;
  parallel_for(tasks, threads, [&](std::size_t i) {
    task(Rows{i * rows_per_task, std::min(rows, (i + 1) * rows_per_task)});
  });
}

/// f_r of a channel's bins from `first` on into `f_r`. False if a value is not finite.
bool read_values(const MerlFile& file, std::size_t channel, std::size_t first, std::size_t last,
                 double* f_r) {
  const double scale = merl_scales[channel];
  double check = 0;  // NaN once a value is not finite
  for (std::size_t bin = first; bin < last; ++bin) {
    const double value = file.value(channel, bin);
    check += value * 0;
    f_r[bin] = value < 0 ? hole : value * scale;
  }
  return check == 0;
}

/// Throws for the first value of the file that is not finite.
void read_all_values(const MerlFile& file, const std::string& path, int threads,
                     std::array<double*, channel_count> f_r) {
  const MerlGrid& grid = file.grid;
  std::vector<char> is_row_finite(grid.theta_h_count * grid.theta_d_count, 1);
  for_rows(grid, threads, [&](Rows rows) {
    bool is_finite = true;
    for (std::size_t c = 0; c < channel_count; ++c) {
      is_finite &=
          read_values(file, c, rows.begin * grid.phi_d_count, rows.end * grid.phi_d_count, f_r[c]);
    }
    is_row_finite[rows.begin] = is_finite ? 1 : 0;
  });
  if (std::all_of(is_row_finite.begin(), is_row_finite.end(), [](char ok) { return ok != 0; })) {
    return;
  }
  for (std::size_t c = 0; c < channel_count; ++c) {
    for (std::size_t bin = 0; bin < grid.bins(); ++bin) {
      if (!std::isfinite(file.value(c, bin))) fail_for_value(file, path, c, bin);
    }
  }
}

// The samples -------------------------------------------------------------------------------------

struct Turn {
  double sine, cosine;
};

std::vector<Turn> azimuths(const MerlGrid& grid) {
  std::vector<Turn> turns(grid.phi_d_count);
  for (std::size_t k = 0; k < turns.size(); ++k) {
    turns[k] = {std::sin(grid.phi_d(k)), std::cos(grid.phi_d(k))};
  }
  return turns;
}

/// directions_from() for the bins of a row, whose angles theta_h and theta_d are the same.
void write_directions(const MerlGrid& grid, std::size_t row, const std::vector<Turn>& phi_d,
                      SampleTable& table) {
  const double theta_h = grid.theta_h(row / grid.theta_d_count);
  const double theta_d = grid.theta_d(row % grid.theta_d_count);
  const double sin_h = std::sin(theta_h);
  const double cos_h = std::cos(theta_h);
  const double sin_d = std::sin(theta_d);
  const double along_x = sin_h * std::cos(theta_d);
  const double along_z = cos_h * std::cos(theta_d);
  const std::size_t first = row * grid.phi_d_count;
  for (std::size_t k = 0; k < phi_d.size(); ++k) {
    const double x = sin_d * phi_d[k].cosine;
    const double y = sin_d * phi_d[k].sine;
    table.wi.set(first + k, {along_x + cos_h * x, y, along_z - sin_h * x});
    table.wo.set(first + k, {along_x - cos_h * x, -y, along_z + sin_h * x});
  }
}

void mask_bins(std::size_t first, std::size_t last, SampleTable& table) {
  const double least = std::sin(horizon_tolerance);
  const auto& [r, g, b] = std::tie(table.values[0], table.values[1], table.values[2]);
  for (std::size_t i = first; i < last; ++i) {
    const bool is_hole = std::isnan(r[i]) && std::isnan(g[i]) && std::isnan(b[i]);
    const bool is_horizontal = table.wi.z[i] <= least || table.wo.z[i] <= least;
    table.mask[i] =
        is_horizontal ? MaskReason::horizon : (is_hole ? MaskReason::hole : MaskReason::none);
  }
}

void write_samples(const MerlGrid& grid, int threads, SampleTable& table) {
  const std::vector<Turn> phi_d = azimuths(grid);
  for_rows(grid, threads, [&](Rows rows) {
    for (std::size_t row = rows.begin; row < rows.end; ++row) {
      const std::size_t first = row * grid.phi_d_count;
      const std::size_t last = first + grid.phi_d_count;
      write_directions(grid, row, phi_d, table);
      const double weight = merl_weight(grid, row / grid.theta_d_count, row % grid.theta_d_count);
      std::fill(table.weight.begin() + static_cast<std::ptrdiff_t>(first),
                table.weight.begin() + static_cast<std::ptrdiff_t>(last), weight);
      mask_bins(first, last, table);
    }
  });
}

/// In parallel, since fresh memory is slow to touch.
void resize(SampleTable& table, std::size_t count, int threads) {
  table.values.resize(channel_count);
  const std::array arrays{&table.wi.x,      &table.wi.y,  &table.wi.z,      &table.wo.x,
                          &table.wo.y,      &table.wo.z,  &table.values[0], &table.values[1],
                          &table.values[2], &table.weight};
  parallel_for(arrays.size(), threads, [&](std::size_t i) { arrays[i]->resize(count); });
  table.mask.resize(count, MaskReason::none);
}

/// f_r of every bin, for any number of threads to look up.
struct Lookup {
  MerlGrid grid;
  std::array<std::vector<double>, channel_count> f_r;

  void operator()(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                  std::span<double> result) const {
    const double least = std::sin(horizon_tolerance);
    if (!(wi.z > least && wo.z > least)) {
      std::fill(result.begin(), result.end(), hole);
      return;
    }
    const std::size_t bin = merl_place(grid, wi, wo).bin;
    for (std::size_t c = 0; c < channel_count; ++c) result[c] = f_r[c][bin];
  }
};

}  // namespace

bool is_merl(std::string_view content) {
  const std::optional<Sizes> sizes = sizes_in(content);
  if (!sizes) return false;
  if (*sizes == sizes_of_merl) return true;
  const std::optional<std::size_t> expected = file_size(*sizes);
  return expected && content.size() >= *expected / 2 && content.size() / 2 <= *expected;
}

SampleTable read_merl(std::string_view content, const std::string& path,
                      const ReadOptions& options) {
  const MerlFile file = open(content, path);
  SampleTable table;
  table.name = name_from(path);
  table.channels = channel_names();
  table.notes = notes_on(file);
  table.provenance = provenance_of(path);
  table.takes_isotropy = true;
  table.weight_is_solid_angle = true;
  resize(table, file.grid.bins(), options.threads);
  read_all_values(file, path, options.threads,
                  {table.values[0].data(), table.values[1].data(), table.values[2].data()});
  write_samples(file.grid, options.threads, table);
  return table;
}

GriddedTable read_merl_grid(std::string_view content, const std::string& path) {
  const MerlFile file = open(content, path);
  auto lookup = std::make_shared<Lookup>();
  lookup->grid = file.grid;
  for (std::vector<double>& f_r : lookup->f_r) f_r.resize(file.grid.bins());
  read_all_values(file, path, 0,
                  {lookup->f_r[0].data(), lookup->f_r[1].data(), lookup->f_r[2].data()});
  return {.name = name_from(path),
          .channels = channel_names(),
          .f_r = [values = std::shared_ptr<const Lookup>(std::move(lookup))](
                     const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                     std::span<double> f_r) { (*values)(wi, wo, f_r); },
          .notes = notes_on(file),
          .provenance = provenance_of(path)};
}

}  // namespace gonio::table
