#include "trade/table_choice.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "lut/layout.h"
#include "lut/table_model.h"

namespace gonio::trade {
namespace {

/// Every so many of the directions at a table's texels tell most tables that are too coarse.
constexpr std::size_t first_look = 101;

constexpr std::array coordinates{lut::Coordinate::cosine, lut::Coordinate::sqrt,
                                 lut::Coordinate::fourth_root};
constexpr std::array filters{lut::Filter::linear, lut::Filter::nearest};

/// A step through a list that meets all of it, and early on a bit of everywhere.
std::size_t golden_step(std::size_t size) {
  auto step = std::max<std::size_t>(1, std::size_t(0.618 * double(size)));
  while (std::gcd(step, size) > 1) --step;
  return step;
}

/// The material, where its tables are checked, and what is asked of them.
struct Task {
  const brdf::BoundModel& model;
  const TableLimits& limits;
  const Reference& reference;

  /// The error over the pairs, if it is within the limits: most tables are past them after a few.
  std::optional<EvaluatorError> good_error(const Reference& where, const lut::Table& table,
                                           lut::Filter filter, lut::Weights weights) const {
    const lut::TableModel by_table(model, table, filter, weights);
    std::vector<double> f_r(where.channels);
    ErrorSum sum(where);
    const std::size_t size = where.pairs.size();
    const std::size_t step = golden_step(size);
    for (std::size_t k = 0, i = 0; k < size; ++k, i = (i + step) % size) {
      by_table.f_r(where.pairs[i].wi, where.pairs[i].wo, f_r);
      sum.add(i, f_r);
      if (!keeps(limits, sum.error())) return std::nullopt;
    }
    return sum.error();
  }

  /// The same everywhere, with either weights.
  std::optional<EvaluatorError> good_error(const TableChoice& choice) const {
    const lut::Table table = lut::bake(choice.layout);
    EvaluatorError worst;
    const auto is_good = [&](const Reference& where) {
      for (const lut::Weights weights : {lut::Weights::quantised, lut::Weights::exact}) {
        const auto error = good_error(where, table, choice.filter, weights);
        if (!error) return false;
        worst = worse_of(worst, *error);
      }
      return true;
    };
    const auto is_good_at_texels = [&](std::size_t every) {
      return is_good(reference_at_texels(model, choice.layout, reference.gauge, every));
    };
    const bool all_good =
        is_good(reference) && is_good_at_texels(first_look) && is_good_at_texels(1);
    return all_good ? std::optional(worst) : std::nullopt;
  }
};

/// How many rows a table of the width may have.
std::vector<int> heights_of(const lut::Layout& layout, int width) {
  if (lut::is_strauss(layout.kind)) return {width};
  if (layout.height == 1) return {1};
  return {lut::least_size, 2 * lut::least_size, 4 * lut::least_size, 8 * lut::least_size};
}

bool is_layout(const lut::Layout& layout) {
  try {
    lut::check(layout);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// The tables of one kind that differ in their size and storage alone, cheapest to read first.
std::vector<TableChoice> families_of(const brdf::BoundModel& model, lut::TableKind kind) {
  std::vector<TableChoice> families;
  for (const lut::Filter filter : filters) {
    for (const lut::Coordinate coordinate : coordinates) {
      TableChoice family{lut::layout_for(model, kind), filter};
      family.layout.coordinate = coordinate;
      const double reach = lut::lobe_reach(family.layout);
      family.layout.reach = 1;
      if (is_layout(family.layout)) families.push_back(family);
      family.layout.reach = reach;
      if (reach < 1 && is_layout(family.layout)) families.push_back(family);
    }
  }
  return families;
}

/// The members of a family in a storage that are below so many bytes, smallest first.
std::vector<TableChoice> members_of(const TableChoice& family, lut::Storage storage,
                                    std::size_t below) {
  std::vector<TableChoice> members;
  for (int width = lut::least_size; width <= lut::largest_size; width *= 2) {
    for (const int height : heights_of(family.layout, width)) {
      TableChoice member = family;
      member.layout.width = width;
      member.layout.height = height;
      member.layout.storage = storage;
      if (size_of(member.layout) < below && is_layout(member.layout)) members.push_back(member);
    }
  }
  std::stable_sort(members.begin(), members.end(), [](const auto& a, const auto& b) {
    return size_of(a.layout) < size_of(b.layout);
  });
  return members;
}

std::optional<GoodTable> smallest_in(const Task& task, const std::vector<TableChoice>& families,
                                     lut::Storage storage) {
  std::optional<GoodTable> best;
  for (const TableChoice& family : families) {
    for (const TableChoice& table :
         members_of(family, storage, best ? best->bytes : most_bytes + 1)) {
      const auto error = task.good_error(table);
      if (!error) continue;
      best = GoodTable{table, size_of(table.layout), *error};
      break;
    }
  }
  return best;
}

}  // namespace

ResidualUse residual_use(const Reference& reference, const std::optional<double>& residual) {
  if (!residual) return ResidualUse::unknown;
  if (reference.samples == 0) return ResidualUse::over_other_directions;
  const double of_float = share_of_float * radiance_rms(reference, reference.f_r);
  return share_of_residual * *residual > of_float ? ResidualUse::limits : ResidualUse::below_float;
}

TableLimits limits_of(const Reference& reference, double tolerance,
                      const std::optional<double>& residual) {
  TableLimits limits{tolerance, std::nullopt};
  if (residual_use(reference, residual) == ResidualUse::limits) {
    limits.rms = share_of_residual * *residual;
  }
  return limits;
}

TableLimits with_headroom(const TableLimits& limits) {
  constexpr double headroom = 0.95;
  TableLimits less{headroom * limits.largest, std::nullopt};
  if (limits.rms) less.rms = headroom * *limits.rms;
  return less;
}

bool keeps(const TableLimits& limits, const EvaluatorError& error) {
  return error.largest <= limits.largest && (!limits.rms || error.rms < *limits.rms);
}

std::vector<GoodTable> smallest_tables(const brdf::BoundModel& model, const Reference& reference,
                                       const TableLimits& limits) {
  const std::vector<lut::TableKind> kinds = lut::tables_for(model.model());
  if (kinds.empty()) {
    throw std::invalid_argument("there is no look-up table for the model " + model.model().name());
  }
  std::vector<TableChoice> families;
  for (const lut::TableKind kind : kinds) {
    const auto of_kind = families_of(model, kind);
    families.insert(families.end(), of_kind.begin(), of_kind.end());
  }
  const Task task{model, limits, reference};
  std::vector<GoodTable> smallest;
  for (const lut::Storage storage : lut::all_storages) {
    if (auto table = smallest_in(task, families, storage)) smallest.push_back(*table);
  }
  std::stable_sort(smallest.begin(), smallest.end(),
                   [](const auto& a, const auto& b) { return a.bytes < b.bytes; });
  return smallest;
}

}  // namespace gonio::trade
