#include "trade/table_choice.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "lut/layout.h"

namespace gonio::trade {
namespace {

/// So many pairs of the grid and of the samples tell most tables that are too coarse.
constexpr std::size_t first_look = 1000;
/// The root mean square over so few of the pairs may be off by as much.
constexpr double first_look_excess = 1.5;

constexpr std::array coordinates{lut::Coordinate::cosine, lut::Coordinate::sqrt,
                                 lut::Coordinate::fourth_root};
constexpr std::array filters{lut::Filter::linear, lut::Filter::nearest};

/// The material, where its tables are checked, and what is asked of them.
struct Task {
  const brdf::BoundModel& model;
  const TableLimits& limits;
  const Reference& reference;
  const Reference few;          // of the pairs
  const Reference few_of_grid;  // and every sample

  /// The error over all pairs, if it is within the limits.
  std::optional<EvaluatorError> good_error(const TableChoice& choice) const {
    const lut::Table table = lut::bake(choice.layout);
    const auto error = [&](const Reference& where) {
      return predicted_error(model, where, table, choice.filter, lut::Weights::quantised);
    };
    EvaluatorError at_first = error(few);
    at_first.rms /= first_look_excess;
    if (!keeps(limits, at_first)) return std::nullopt;
    if (reference.samples > 0 && !keeps(limits, error(few_of_grid))) return std::nullopt;
    const EvaluatorError all = error(reference);
    return keeps(limits, all) ? std::optional(all) : std::nullopt;
  }
};

bool is_square(lut::TableKind kind) {
  return kind == lut::TableKind::strauss_j || kind == lut::TableKind::strauss_terms;
}

/// How many rows a table of the width may have.
std::vector<int> heights_of(const lut::Layout& layout, int width) {
  if (is_square(layout.kind)) return {width};
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

TableLimits limits_of(double tolerance, const std::optional<double>& residual) {
  constexpr double headroom = 0.95;
  TableLimits limits{headroom * tolerance, std::nullopt};
  if (residual) limits.rms = headroom * share_of_residual * *residual;
  return limits;
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
  const Task task{model, limits, reference, thinned(reference, first_look, first_look),
                  thinned(reference, first_look, reference.samples)};
  std::vector<GoodTable> smallest;
  for (const lut::Storage storage : lut::all_storages) {
    if (auto table = smallest_in(task, families, storage)) smallest.push_back(*table);
  }
  std::stable_sort(smallest.begin(), smallest.end(),
                   [](const auto& a, const auto& b) { return a.bytes < b.bytes; });
  return smallest;
}

}  // namespace gonio::trade
