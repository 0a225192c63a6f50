// The project's JSON schemas, as a validator that is not ours understands them.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

namespace gonio::tests {

/// A schema of the folder schema/, as a draft 7 validator understands it.
class Schema {
 public:
  explicit Schema(const std::string& file)
      : document_(nlohmann::json::parse(
            std::ifstream(std::string(GONIO_SOURCE_DIR) + "/schema/" + file))) {
    valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
    parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(document_), schema_);
  }

  /// Empty if the schema accepts the instance, else the first reason.
  std::string complaint(const nlohmann::json& instance) const {
    valijson::Validator validator(valijson::Validator::kStrongTypes);
    valijson::ValidationResults results;
    if (validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(instance), &results)) {
      return "";
    }
    valijson::ValidationResults::Error error;
    results.popError(error);
    std::string text;
    for (const std::string& step : error.context) text += step;
    return text + ": " + error.description;
  }

 private:
  nlohmann::json document_;
  valijson::Schema schema_;
};

}  // namespace gonio::tests
