// The samples that a fit uses, chunk by chunk, and how much each counts under the metric.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fit/batch_model.h"
#include "fit/options.h"
#include "fit/parameters.h"
#include "fit/survey.h"
#include "table/sample_table.h"

namespace gonio::fit {

/// The used samples among chunk_rows consecutive ones of the table. Like the directions, all
/// columns go on to the end of the last pack, with values, factors and weights of 0.
struct SampleChunk {
  /// Where each sample stands in the table.
  std::array<std::size_t, chunk_rows> samples;
  DirectionChunk directions;
  /// f_r, [row, channel]; 0 where the channel was not measured.
  Eigen::MatrixXd values;
  /// What the metric multiplies (residual.h), [row, 0] for all channels or [row, channel]; 0 where
  /// the channel was not measured.
  Eigen::MatrixXd factors;
  /// The table's weights; 1 where it carries none.
  std::array<double, chunk_rows> weights;

  explicit SampleChunk(std::size_t channels);

  /// Rows including the padding of the last pack.
  std::size_t padded_count() const {
    return (directions.count + brdf::Pack::size - 1) / brdf::Pack::size * brdf::Pack::size;
  }
};

/// A view of a table under a metric. The chunks, and with them every sum over the samples, are
/// the same for any number of threads.
class WeightedSamples {
 public:
  /// Keeps references to the table, to the model, and, with options.noise, to `reference`: the
  /// parameters whose model values give sigma; without a reference the measured values do. `floors`
  /// (relative_floors()) are needed by the relative metric only. Throws std::invalid_argument if
  /// chi2 has no sigma, table::FileError if a noise of 0 would give a sample an infinite weight.
  WeightedSamples(const table::SampleTable& table, const BatchModel& model, const Options& options,
                  const Survey& survey, std::span<const double> floors = {},
                  const ParameterValues* reference = nullptr);

  const table::SampleTable& table() const { return *table_; }
  const table::SampleFilter& filter() const { return filter_; }
  Metric metric() const { return metric_; }
  std::size_t chunk_count() const;
  std::size_t channel_count() const { return table_->channels.size(); }
  /// True if a row counts the same in every channel: SampleChunk::factors has one column.
  bool shared_factors() const { return shared_factors_; }
  /// The column of SampleChunk::factors that holds a channel's.
  Eigen::Index factor_column(Eigen::Index channel) const { return shared_factors_ ? 0 : channel; }
  bool has_weight() const { return table_->has_weight(); }
  const Survey& survey() const { return survey_; }

  /// Fills `chunk` with the used samples of the given chunk, in the table's order.
  void gather(std::size_t chunk_index, SampleChunk& chunk) const;

 private:
  void gather_factors(SampleChunk& chunk) const;
  void gather_noise(SampleChunk& chunk) const;
  double factor_of_noise(double value) const;

  const table::SampleTable* table_;
  table::SampleFilter filter_;
  const BatchModel* model_;
  Metric metric_;
  std::optional<Noise> noise_;
  Survey survey_;
  std::vector<double> floors_;
  const ParameterValues* reference_;
  bool shared_factors_;
};

/// What the rows of one channel are made of, in columns that are all padded_count() long.
struct ChannelColumns {
  const double* values;
  const double* model;  // f_r
  const double* cos_i;
  const double* factors;
  const double* weights;
  std::size_t count;
};

/// Of a channel of a chunk of the samples; `model` holds the model's values.
inline ChannelColumns columns_of(const SampleChunk& chunk, const WeightedSamples& samples,
                                 Eigen::Index channel, const double* model) {
  return {chunk.values.col(channel).data(),
          model,
          chunk.directions.wi_z.data(),
          chunk.factors.col(samples.factor_column(channel)).data(),
          chunk.weights.data(),
          chunk.padded_count()};
}

}  // namespace gonio::fit
