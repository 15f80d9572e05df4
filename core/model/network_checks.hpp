// Whether a model's spring network can be relied on.
#pragma once

namespace pliant {

class ModelView;

/// Every patch, link and blend names patches that are there, patches have the points that they say, links
/// stand once each and in order, places lie about the object, lengths are positive and no longer than the
/// object. The counts and sections of `view` must have been checked.
[[nodiscard]] bool network_is_sane(const ModelView& view) noexcept;

}  // namespace pliant
