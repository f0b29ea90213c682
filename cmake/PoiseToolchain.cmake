# Language level, warnings, sanitizers and the compiler cache: what every target shares.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo)
endif()

find_program(POISE_CCACHE ccache)
if(POISE_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${POISE_CCACHE}")
endif()

# Eigen's alignment is part of our ABI: pin it, so that objects built for different instruction
# sets agree on the layout of what they pass to each other.
add_compile_definitions(EIGEN_MAX_ALIGN_BYTES=16)

# Our own code only; system and generated headers stay out of it.
set(POISE_WARNINGS -Wall -Wextra -Werror -Wno-error=deprecated-declarations)
set(POISE_KERNEL_WARNINGS "")

set(POISE_TEST_ENVIRONMENT "")
if(POISE_SANITIZER)
  add_compile_options(-fsanitize=${POISE_SANITIZER} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${POISE_SANITIZER})
  # GCC warns of its own AVX-512 headers in instrumented code (GCC bug 105593).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    list(APPEND POISE_WARNINGS -Wno-maybe-uninitialized)
    set(POISE_KERNEL_WARNINGS -Wno-uninitialized)
  endif()
  if(POISE_SANITIZER STREQUAL "address")
    add_compile_options(-fsanitize=undefined -fno-sanitize-recover=undefined)
    add_link_options(-fsanitize=undefined)
    set(POISE_TEST_ENVIRONMENT
        "ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:abort_on_error=1")
  else()
    # gRPC, Abseil, protobuf and OpenMP come from Debian without instrumentation.
    set(POISE_TEST_ENVIRONMENT
        "TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/support/tsan_suppressions.txt")
  endif()
endif()

if(POISE_BUILD_FUZZERS)
  # Tells libFuzzer which branches an input took; only the fuzz targets link its main.
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
