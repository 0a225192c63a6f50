#include "fit/weighted_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "table/file_error.h"

namespace gonio::fit {
namespace {

/// True if a sample's factor may differ from channel to channel.
bool has_factor_per_channel(Metric metric, const Survey& survey) {
  return metric == Metric::chi2 || metric == Metric::relative || survey.has_holes();
}

}  // namespace

SampleChunk::SampleChunk(std::size_t channels)
    : values(column_stride, Eigen::Index(channels)),
      factors(column_stride, Eigen::Index(channels)) {}

WeightedSamples::WeightedSamples(const table::SampleTable& table, const BatchModel& model,
                                 const Options& options, const Survey& survey,
                                 std::span<const double> floors, const ParameterValues* reference)
    : table_(&table),
      filter_(table, options.max_theta_deg, options.incidence),
      model_(&model),
      metric_(options.metric),
      noise_(options.metric == Metric::chi2 ? options.noise : std::nullopt),
      survey_(survey),
      floors_(floors.begin(), floors.end()),
      reference_(reference),
      shared_factors_(!has_factor_per_channel(options.metric, survey)) {
  if (metric_ == Metric::chi2 && !noise_ && !table.has_sigma()) {
    throw std::invalid_argument(
        fmt::format("{}: metric chi2 needs the noise: the table has no sigma columns; say "
                    "--noise REL,ABS, or choose another metric",
                    table.provenance.path));
  }
}

std::size_t WeightedSamples::chunk_count() const {
  return (table_->size() + chunk_rows - 1) / chunk_rows;
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
  std::size_t count = 0;
  for (std::size_t i = first; i < last; ++i) {
    chunk.samples[count] = i;
    count += filter_(i);
  }
  const auto take = [&, whole = count == last - first](const std::vector<double>& from,
                                                       double* to) {
    if (whole) {
      std::copy_n(from.data() + first, count, to);
    } else {
      for (std::size_t r = 0; r < count; ++r) to[r] = from[chunk.samples[r]];
    }
  };
  DirectionChunk& directions = chunk.directions;
  directions.count = count;
  take(table_->wi.x, directions.wi_x.data());
  take(table_->wi.y, directions.wi_y.data());
  take(table_->wi.z, directions.wi_z.data());
  take(table_->wo.x, directions.wo_x.data());
  take(table_->wo.y, directions.wo_y.data());
  take(table_->wo.z, directions.wo_z.data());
  directions.pad();
  const std::size_t padded = chunk.padded_count();
  for (std::size_t c = 0; c < table_->channels.size(); ++c) {
    double* values = chunk.values.col(Eigen::Index(c)).data();
    take(table_->values[c], values);
    std::fill(values + count, values + padded, 0.0);
  }
  if (has_weight()) {
    take(table_->weight, chunk.weights.data());
  } else {
    std::fill_n(chunk.weights.begin(), count, 1.0);
  }
  std::fill(chunk.weights.begin() + std::ptrdiff_t(count),
            chunk.weights.begin() + std::ptrdiff_t(padded), 0.0);
  gather_factors(chunk);
  if (!survey_.has_holes()) return;
  for (Eigen::Index c = 0; c < chunk.values.cols(); ++c) {
    for (std::size_t r = 0; r < count; ++r) {
      double& value = chunk.values(Eigen::Index(r), c);
      if (!std::isnan(value)) continue;
      value = 0;
      chunk.factors(Eigen::Index(r), c) = 0;
    }
  }
}

void WeightedSamples::gather_factors(SampleChunk& chunk) const {
  const std::size_t count = chunk.directions.count;
  const auto channels = shared_factors_ ? Eigen::Index(1) : chunk.values.cols();
  if (noise_) gather_noise(chunk);
  for (Eigen::Index c = 0; c < channels; ++c) {
    double* factors = chunk.factors.col(c).data();
    std::fill(factors + count, factors + chunk.padded_count(), 0.0);
    if (noise_) continue;
    switch (metric_) {
      case Metric::l2:
      case Metric::log:
      case Metric::cube_root:
        std::fill_n(factors, count, 1.0);
        break;
      case Metric::cosine_l2:
        std::copy_n(chunk.directions.wi_z.begin(), count, factors);
        break;
      case Metric::relative:
        for (std::size_t r = 0; r < count; ++r) {
          factors[r] =
              1 / std::max(std::abs(chunk.values(Eigen::Index(r), c)), floors_[std::size_t(c)]);
        }
        break;
      case Metric::chi2:
        for (std::size_t r = 0; r < count; ++r) {
          factors[r] = 1 / table_->sigma[std::size_t(c)][chunk.samples[r]];
        }
        break;
    }
  }
}

void WeightedSamples::gather_noise(SampleChunk& chunk) const {
  const auto count = Eigen::Index(chunk.directions.count);
  Eigen::MatrixXd expected = chunk.values.topRows(count);
  if (reference_ != nullptr) {
    Eigen::MatrixXd basis(column_stride, Eigen::Index(model_->basis_size()));
    model_->evaluate(chunk.directions, reference_->shape, false, basis);
    expected = basis.topRows(count) * model_->coefficients(reference_->amplitudes);
  }
  for (Eigen::Index c = 0; c < expected.cols(); ++c) {
    for (Eigen::Index r = 0; r < count; ++r) {
      // A hole's factor is set to 0 later.
      chunk.factors(r, c) = std::isnan(expected(r, c)) ? 0 : factor_of_noise(expected(r, c));
    }
  }
}

}  // namespace gonio::fit
