#include "fit/weighted_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "table/file_error.h"

namespace gonio::fit {

SampleChunk::SampleChunk(std::size_t channels)
    : values(chunk_rows, Eigen::Index(channels)), factors(chunk_rows, Eigen::Index(channels)) {}

WeightedSamples::WeightedSamples(const table::SampleTable& table, const BatchModel& model,
                                 const Options& options, const ParameterValues* reference)
    : table_(&table),
      filter_(table, options.max_theta_deg),
      model_(&model),
      metric_(options.metric),
      noise_(options.metric == Metric::chi2 ? options.noise : std::nullopt),
      reference_(reference) {
  if (metric_ == Metric::chi2 && !noise_ && !table.has_sigma()) {
    throw std::invalid_argument(
        fmt::format("{}: metric chi2 needs the noise: the table has no sigma columns; say "
                    "--noise REL,ABS, or choose another metric",
                    table.provenance.path));
  }
  count_used();
  shared_factors_ = metric_ != Metric::chi2 && !has_holes_;
}

std::size_t WeightedSamples::chunk_count() const {
  return (table_->size() + chunk_rows - 1) / chunk_rows;
}

void WeightedSamples::count_used() {
  std::array<std::size_t, table::mask_reason_count> masked{};
  for (std::size_t i = 0; i < table_->size(); ++i) {
    ++masked[std::size_t(table_->mask[i])];
    if (filter_(i)) ++used_samples_;
  }
  if (used_samples_ == 0) {
    std::string reasons;
    for (std::size_t r = 1; r < masked.size(); ++r) {
      if (masked[r] == 0) continue;
      reasons += fmt::format(", {} masked as {}", masked[r], name(table::MaskReason(r)));
    }
    throw table::FileError(fmt::format(
        "{}: no sample left to fit: of {} samples{}, {} lie beyond the largest polar angle or have "
        "the weight 0; check the table with 'gonio info', or raise --max-theta",
        table_->provenance.path, table_->size(), reasons, masked[0]));
  }
  for (const std::vector<double>& channel : table_->values) {
    for (std::size_t i = 0; i < table_->size(); ++i) {
      if (!filter_(i)) continue;
      if (std::isnan(channel[i])) {
        has_holes_ = true;
      } else {
        ++used_values_;
      }
    }
  }
}

double WeightedSamples::factor_of_noise(double value) const {
  const double sigma = std::hypot(noise_->relative * value, noise_->absolute);
  if (!(sigma > 0)) {
    throw table::FileError(fmt::format(
        "{}: --noise {},{} gives a sample of value {} no uncertainty at all and so an infinite "
        "weight; give a positive absolute part",
        table_->provenance.path, noise_->relative, noise_->absolute, value));
  }
  return 1 / sigma;
}

void WeightedSamples::gather(std::size_t chunk_index, SampleChunk& chunk) const {
  const std::size_t first = chunk_index * chunk_rows;
  const std::size_t last = std::min(first + chunk_rows, table_->size());
  std::array<std::size_t, chunk_rows> rows;
  std::size_t count = 0;
  for (std::size_t i = first; i < last; ++i) {
    if (filter_(i)) rows[count++] = i;
  }
  DirectionChunk& directions = chunk.directions;
  directions.count = count;
  for (std::size_t r = 0; r < count; ++r) {
    const std::size_t i = rows[r];
    directions.wi_x[r] = table_->wi.x[i];
    directions.wi_y[r] = table_->wi.y[i];
    directions.wi_z[r] = table_->wi.z[i];
    directions.wo_x[r] = table_->wo.x[i];
    directions.wo_y[r] = table_->wo.y[i];
    directions.wo_z[r] = table_->wo.z[i];
  }

  std::array<double, chunk_rows> shared;
  for (std::size_t r = 0; r < count; ++r) {
    shared[r] = table_->has_weight() ? std::sqrt(table_->weight[rows[r]]) : 1;
    if (metric_ == Metric::cosine_l2) shared[r] *= directions.wi_z[r];
  }
  Eigen::MatrixXd reference_basis;
  if (noise_ && reference_ != nullptr) {
    reference_basis.resize(chunk_rows, Eigen::Index(model_->amplitude_count()));
    model_->evaluate(directions, reference_->shape, false, reference_basis);
  }

  for (std::size_t c = 0; c < table_->channels.size(); ++c) {
    const auto column = Eigen::Index(c);
    for (std::size_t r = 0; r < count; ++r) {
      const double value = table_->values[c][rows[r]];
      chunk.values(Eigen::Index(r), column) = std::isnan(value) ? 0 : value;
    }
    if (shared_factors_) continue;
    for (std::size_t r = 0; r < count; ++r) {
      const auto row = Eigen::Index(r);
      double factor = shared[r];
      const double value = table_->values[c][rows[r]];
      if (std::isnan(value)) {
        factor = 0;
      } else if (noise_) {
        factor *=
            factor_of_noise(reference_ == nullptr
                                ? value
                                : reference_basis.row(row).dot(reference_->amplitudes.col(column)));
      } else if (metric_ == Metric::chi2) {
        factor /= table_->sigma[c][rows[r]];
      }
      chunk.factors(row, column) = factor;
    }
  }
  if (shared_factors_) {
    for (std::size_t r = 0; r < count; ++r) chunk.factors(Eigen::Index(r), 0) = shared[r];
  }
}

}  // namespace gonio::fit
