#ifndef POISE_CORE_BASE_VERSION_H_
#define POISE_CORE_BASE_VERSION_H_

namespace poise::base {

/// The version of this build, from the root CMakeLists.txt: "0.1.0".
const char* Version();

}  // namespace poise::base

#endif  // POISE_CORE_BASE_VERSION_H_
