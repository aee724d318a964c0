# Lists the components of the program: AYUMI_LIBRARIES for people ("Eigen 3.4.0, ..."), and the file
# AYUMI_BILL, a software bill of materials (CycloneDX 1.5). Both come from the one table below, and
# nothing in them depends on the time or the place of the build.

# name | version | licence (SPDX) | package URL without version | how it comes into the program
set(ayumi_components
  "Eigen|${Eigen3_VERSION}|MPL-2.0|pkg:generic/eigen|compiled in"
  "Ipopt|${IPOPT_VERSION}|EPL-1.0|pkg:generic/ipopt|shared library"
  "Ceres|${Ceres_VERSION}|BSD-3-Clause|pkg:generic/ceres-solver|static or shared library"
  "Boost|${Boost_VERSION_STRING}|BSL-1.0|pkg:generic/boost|compiled in"
  "urdfdom|${URDFDOM_urdfdom_VERSION}|BSD-3-Clause|pkg:generic/urdfdom|shared library"
  "TinyXML|${URDFDOM_tinyxml_VERSION}|Zlib|pkg:generic/tinyxml|shared library"
  "assimp|${assimp_VERSION}|BSD-3-Clause|pkg:generic/assimp|shared library of ayumi-mesh-reader"
  "nlohmann-json|${nlohmann_json_VERSION}|MIT|pkg:generic/nlohmann-json|compiled in"
  "OpenSSL|${OPENSSL_VERSION}|Apache-2.0|pkg:generic/openssl|shared library"
  "zlib|${ZLIB_VERSION_STRING}|Zlib|pkg:generic/zlib|shared library"
  "zstd|${ZSTD_VERSION}|BSD-3-Clause OR GPL-2.0-only|pkg:generic/zstd|shared library"
  "libzip|${LIBZIP_VERSION}|BSD-3-Clause|pkg:generic/libzip|shared library"
  "yaml-cpp|${YAML_CPP_VERSION}|MIT|pkg:generic/yaml-cpp|shared library"
  "libjpeg|${JPEG_VERSION}|IJG AND BSD-3-Clause AND Zlib|pkg:generic/libjpeg-turbo|shared library"
  "cairo|${CAIRO_VERSION}|LGPL-2.1-only OR MPL-1.1|pkg:generic/cairo|shared library"
  "CLI11|${CLI11_VERSION}|BSD-3-Clause|pkg:generic/cli11|compiled in"
  "cpp-httplib|${HTTPLIB_VERSION}|MIT|pkg:generic/cpp-httplib|shared library"
  "SQLite|${SQLITE_VERSION}|blessing|pkg:generic/sqlite|shared library")
if(OSMESA_FOUND)
  list(APPEND ayumi_components
    "OSMesa|${OSMESA_VERSION}|MIT|pkg:generic/mesa|shared library, loaded by the first picture")
else()
  list(APPEND ayumi_components "EGL|${EGL_VERSION}|MIT|pkg:generic/libglvnd|shared library")
endif()
if(SECCOMP_FOUND)
  list(APPEND ayumi_components "libseccomp|${SECCOMP_VERSION}|LGPL-2.1-only|\
pkg:generic/libseccomp|shared library of ayumi-mesh-reader")
endif()
if(TARGET ayumi_plant_mujoco)
  file(STRINGS ${MUJOCO_INCLUDE}/mujoco/mujoco.h number REGEX "define mjVERSION_HEADER")
  string(REGEX REPLACE ".*HEADER +([0-9]+)([0-9])([0-9]).*" "\\1.\\2.\\3" number "${number}")
  list(APPEND ayumi_components
    "MuJoCo|${number}|Apache-2.0|pkg:generic/mujoco|shared library")
endif()
if(TARGET ayumi_python)
  list(APPEND ayumi_components
    "pybind11|${pybind11_VERSION}|BSD-3-Clause|pkg:generic/pybind11|compiled into the Python module")
endif()
if(AYUMI_NODE)
  file(READ ${AYUMI_NODE_MODULES}/three/package.json package)
  string(JSON number GET "${package}" version)
  list(APPEND ayumi_components
    "three.js|${number}|MIT|pkg:npm/three|compiled into the report page and the page of author")
endif()

set(names "")
set(entries "")
foreach(component IN LISTS ayumi_components)
  string(REPLACE "|" ";" fields "${component}")
  list(GET fields 0 name)
  list(GET fields 1 number)
  list(GET fields 2 licence)
  list(GET fields 3 url)
  list(GET fields 4 way)
  if(number STREQUAL "")
    message(FATAL_ERROR "The version of ${name} is not known; lib/cmake/components.cmake needs it")
  endif()
  list(APPEND names "${name} ${number}")
  list(APPEND entries "    {
      \"type\": \"library\",
      \"bom-ref\": \"${url}@${number}\",
      \"name\": \"${name}\",
      \"version\": \"${number}\",
      \"licenses\": [{\"expression\": \"${licence}\"}],
      \"purl\": \"${url}@${number}\",
      \"properties\": [{\"name\": \"ayumi:use\", \"value\": \"${way}\"}]
    }")
endforeach()
list(JOIN names ", " AYUMI_LIBRARIES)
list(JOIN entries ",\n" entries)
set(AYUMI_BILL ${PROJECT_BINARY_DIR}/ayumi.cdx.json)
file(CONFIGURE OUTPUT ${AYUMI_BILL} @ONLY CONTENT "{
  \"bomFormat\": \"CycloneDX\",
  \"specVersion\": \"1.5\",
  \"version\": 1,
  \"metadata\": {
    \"component\": {
      \"type\": \"application\",
      \"bom-ref\": \"pkg:generic/ayumi@${PROJECT_VERSION}\",
      \"name\": \"ayumi\",
      \"version\": \"${PROJECT_VERSION}\",
      \"licenses\": [{\"expression\": \"Apache-2.0\"}],
      \"purl\": \"pkg:generic/ayumi@${PROJECT_VERSION}\"
    }
  },
  \"components\": [
${entries}
  ]
}
")
