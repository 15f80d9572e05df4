// What a person can do about a write that failed.
#pragma once

#include <cerrno>

namespace pliant {

/// The mend for an errno of a failed write, to stand behind the reason: "; free some space". Empty where
/// there is none to tell.
[[nodiscard]] inline const char* write_mend(int fault) noexcept {
  switch (fault) {
    case ENOENT:
      return "; make the folder first";
    case ENOSPC:
    case EDQUOT:
      return "; free some space";
    case EFBIG:
      return "; raise the limit of a file's size (ulimit -f), or write less";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; choose a place that may be written to";
    case EISDIR:
      return "; name a file, not a folder";
    default:
      return "";
  }
}

}  // namespace pliant
