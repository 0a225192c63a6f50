// The samples that a fit uses, chunk by chunk, and how much each counts under the metric.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "fit/batch_model.h"
#include "fit/options.h"
#include "fit/parameters.h"
#include "table/sample_table.h"

namespace gonio::fit {

/// The used samples among chunk_rows consecutive ones of the table.
struct SampleChunk {
  DirectionChunk directions;
  /// f_r, [row, channel]; 0 where the channel was not measured.
  Eigen::MatrixXd values;
  /// The factor of the residual f - model, [row, 0] for all channels or [row, channel]; 0 where
  /// the channel was not measured.
  Eigen::MatrixXd factors;

  explicit SampleChunk(std::size_t channels);
};

/// A view of a table under a metric. The chunks, and with them every sum over the samples, are
/// the same for any number of threads.
class WeightedSamples {
 public:
  /// Keeps references to the table and, with options.noise, to `reference`: the parameters whose
  /// model values give sigma; without a reference the measured values do. Throws
  /// std::invalid_argument if chi2 has no sigma, table::FileError if no sample is left, or a
  /// noise of 0 would give a sample an infinite weight.
  WeightedSamples(const table::SampleTable& table, const BatchModel& model, const Options& options,
                  const ParameterValues* reference = nullptr);

  const table::SampleTable& table() const { return *table_; }
  const table::SampleFilter& filter() const { return filter_; }
  std::size_t chunk_count() const;
  std::size_t channel_count() const { return table_->channels.size(); }
  /// True if a row counts the same in every channel: SampleChunk::factors has one column.
  bool shared_factors() const { return shared_factors_; }
  /// Samples used, and measured values among them (all channels).
  std::size_t used_samples() const { return used_samples_; }
  std::size_t used_values() const { return used_values_; }

  /// Fills `chunk` with the used samples of the given chunk, in the table's order.
  void gather(std::size_t chunk_index, SampleChunk& chunk) const;

 private:
  void count_used();
  double factor_of_noise(double value) const;

  const table::SampleTable* table_;
  table::SampleFilter filter_;
  const BatchModel* model_;
  Metric metric_;
  std::optional<Noise> noise_;
  const ParameterValues* reference_;
  bool has_holes_ = false;
  bool shared_factors_ = true;
  std::size_t used_samples_ = 0;
  std::size_t used_values_ = 0;
};

}  // namespace gonio::fit
