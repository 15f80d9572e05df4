// What is in a model, for people.
#pragma once

#include <string>

#include "core/model/model_view.hpp"

namespace pliant {

/// Some lines "name: value", each with its line end.
[[nodiscard]] std::string describe_model(const ModelView& model);

/// Why the shape cannot be localised, in words; empty for Ambiguity::none.
[[nodiscard]] const char* describe(ModelHeader::Ambiguity ambiguity) noexcept;

}  // namespace pliant
