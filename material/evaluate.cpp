#include "material/evaluate.h"

namespace gonio::material {
namespace {

std::vector<brdf::NamedValues> values_of(const Material& material) {
  std::vector<brdf::NamedValues> values;
  for (const ParameterValue& p : material.parameters) values.push_back({p.name, p.value});
  return values;
}

}  // namespace

brdf::Model model_of(const Material& material) {
  return brdf::model_for(material.model, values_of(material));
}

brdf::BoundModel bind(const Material& material) {
  return {model_of(material), material.channels.size(), values_of(material)};
}

std::vector<std::vector<double>> evaluate(const Material& material,
                                          const table::SampleTable& table) {
  const brdf::BoundModel model = bind(material);
  std::vector<std::vector<double>> result(model.channel_count(), std::vector<double>(table.size()));
  std::vector<double> f_r(model.channel_count());
  for (std::size_t i = 0; i < table.size(); ++i) {
    // A cosine that only rounding keeps from 0 would make a lobe huge.
    if (table.mask[i] == table::MaskReason::horizon) continue;
    model.f_r(table.wi[i], table.wo[i], f_r);
    for (std::size_t c = 0; c < f_r.size(); ++c) result[c][i] = f_r[c];
  }
  return result;
}

}  // namespace gonio::material
