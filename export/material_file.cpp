#include "export/material_file.h"

#include "material/material_json.h"
#include "table/json_file.h"

namespace gonio::exports {

Exported to_material_file(const material::Material& material) {
  return {.files = {{"", table::json_text(to_json(material))}},
          .loss = {},
          .fitted_as = "exact: the material itself",
          .warnings = {}};
}

}  // namespace gonio::exports
