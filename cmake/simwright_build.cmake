# Compiler settings, and the function that declares every module.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# The Python module is a shared library made of the same objects. Hidden symbols keep calls direct
# there, and keep them apart from those of another libtorch in the same process.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# -ffp-contract=off gives the same numbers with any instruction set. Warnings that g++ 12 reports
# falsely inside std::string, Eigen and CGAL at -O3 are off.
add_compile_options(-Wall -Wextra -ffp-contract=off -ffunction-sections -fdata-sections)
add_link_options(-Wl,--gc-sections -Wl,--as-needed)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow
                      -Wno-stringop-overread -Wno-restrict)
  # g++ collects no garbage below 1.5 GB: a batch needs 1 to 2 GB, and compiles 7 % faster.
  add_compile_options(--param=ggc-min-heapsize=1500000)
  if(SIMWRIGHT_UNITY)
    # A source in a batch is no main file: g++ takes its unnamed namespaces for a header's.
    add_compile_options(-Wno-subobject-linkage)
  endif()
endif()
# As many compilers at a time as the memory holds.
cmake_host_system_information(RESULT memory_in_mib QUERY TOTAL_PHYSICAL_MEMORY)
math(EXPR compilers "${memory_in_mib} / 2048")
if(compilers LESS 1)
  set(compilers 1)
endif()
set_property(GLOBAL PROPERTY JOB_POOLS compile=${compilers})
set(CMAKE_JOB_POOL_COMPILE compile)
if(SIMWRIGHT_WERROR)
  add_compile_options(-Werror)
endif()
if(SIMWRIGHT_SANITIZE)
  # The address sanitizer stops at null and freed pointers too: the checks of every member access
  # would only repeat that, for a third of the compile time.
  add_compile_options(-fsanitize=address,undefined
                      -fno-sanitize=vptr,function,null,alignment,object-size
                      -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
  add_compile_definitions(SIMWRIGHT_SANITIZED)
endif()
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # Paths relative to the source folder let a second clone reuse the cache of the first. Precompiled
  # headers are compared by content, not by time.
  set(ccache_launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
      CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      ${CCACHE_PROGRAM})
  set(CMAKE_C_COMPILER_LAUNCHER ${ccache_launcher})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${ccache_launcher})
endif()

# The compiler options that let ccache serve sources with a precompiled header.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(simwright_pch_options -fpch-preprocess)
else()
  set(simwright_pch_options "SHELL:-Xclang -fno-pch-timestamp")
endif()

# simwright_precompile(TARGET HEADER) precompiles cmake/precompiled/HEADER for TARGET;
# simwright_precompile(TARGET REUSE OTHER) reuses the precompiled header of the target OTHER.
function(simwright_precompile target header)
  if(header STREQUAL REUSE)
    target_precompile_headers(${target} REUSE_FROM ${ARGN})
    # Executables would get -fPIE, and refuse the header of a library, which has -fPIC.
    get_target_property(type ${target} TYPE)
    if(type STREQUAL EXECUTABLE)
      set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
      target_compile_options(${target} PRIVATE -fPIC)
    endif()
  else()
    target_precompile_headers(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled/${header})
  endif()
  target_compile_options(${target} PRIVATE ${simwright_pch_options})
endfunction()

# simwright_unity(TARGET): compiles the sources of TARGET eight at a time where SIMWRIGHT_UNITY is on.
# The headers' templates, which take most of the time, are then instantiated once for eight files.
function(simwright_unity target)
  set_target_properties(${target} PROPERTIES
    UNITY_BUILD ${SIMWRIGHT_UNITY} UNITY_BUILD_BATCH_SIZE 8)
endfunction()

# simwright_torch_objects(TARGET SOURCES HEADER_OWNER lib...) compiles the list SOURCES, which
# include libtorch, with libtorch's precompiled header and adds the objects to TARGET. The other
# sources of TARGET do without it: at -O3 its inline functions cost 8 s per file.
function(simwright_torch_objects target sources header_owner)
  add_library(${target}_torch OBJECT ${sources})
  target_include_directories(${target}_torch PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target}_torch PRIVATE ${ARGN})
  simwright_precompile(${target}_torch REUSE ${header_owner})
  simwright_unity(${target}_torch)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_torch>)
endfunction()

# simwright_module(NAME [FOLDERS folder...] [PUBLIC lib...] [PRIVATE lib...] [TORCH file...])
# Declares the static library simwright::NAME with the sources of the folder and of its FOLDERS.
# PUBLIC: libraries that its headers include; PRIVATE: libraries that only its sources include;
# TORCH: the sources that include libtorch, if not all do.
function(simwright_module name)
  cmake_parse_arguments(arg "" "" "FOLDERS;PUBLIC;PRIVATE;TORCH" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  file(GLOB headers CONFIGURE_DEPENDS *.h)
  foreach(folder ${arg_FOLDERS})
    file(GLOB folder_sources CONFIGURE_DEPENDS ${folder}/*.cpp)
    file(GLOB folder_headers CONFIGURE_DEPENDS ${folder}/*.h)
    list(APPEND sources ${folder_sources})
    list(APPEND headers ${folder_headers})
  endforeach()
  list(TRANSFORM arg_TORCH PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  list(REMOVE_ITEM sources ${arg_TORCH})
  add_library(simwright_${name} STATIC ${sources} ${headers})
  add_library(simwright::${name} ALIAS simwright_${name})
  set_target_properties(simwright_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(simwright_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                             $<INSTALL_INTERFACE:include> $<INSTALL_INTERFACE:include/simwright>)
  target_compile_features(simwright_${name} PUBLIC cxx_std_20)
  target_compile_definitions(simwright_${name} PRIVATE SIMWRIGHT_VERSION="${PROJECT_VERSION}")
  target_link_libraries(simwright_${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  # For find_package(simwright COMPONENTS name): what the installed library links.
  set_property(GLOBAL APPEND PROPERTY simwright_modules ${name})
  set(links ${arg_PUBLIC} ${arg_PRIVATE})
  list(FILTER links EXCLUDE REGEX "BUILD_INTERFACE|INSTALL_INTERFACE")
  set_property(GLOBAL PROPERTY simwright_links_${name} ${links})
  simwright_unity(simwright_${name})
  if(name STREQUAL core)
    simwright_precompile(simwright_core standard.h)
  elseif(name STREQUAL nn)
    simwright_precompile(simwright_nn torch.h)
  elseif(name STREQUAL geometry)
    simwright_precompile(simwright_geometry cgal.h)
  else()
    simwright_precompile(simwright_${name} REUSE simwright_core)
  endif()
  if(arg_TORCH)
    simwright_torch_objects(simwright_${name} "${arg_TORCH}" simwright_nn
                            ${arg_PUBLIC} ${arg_PRIVATE})
    target_compile_definitions(simwright_${name}_torch PRIVATE
                               SIMWRIGHT_VERSION="${PROJECT_VERSION}")
  endif()
  install(TARGETS simwright_${name} EXPORT simwright_targets ARCHIVE DESTINATION lib)
endfunction()

# simwright_public_headers(HEADER...) lists the headers of this folder's module that users of the
# library include. Only they are installed. tests/architecture reads the list.
function(simwright_public_headers)
  get_filename_component(module ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  foreach(header ${ARGN})
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${header} DESTINATION include/simwright/${module}/${folder})
  endforeach()
endfunction()

# simwright_shared_headers(HEADER...) lists the other headers of this folder's module that other
# modules include. They are not installed; the list is for tests/architecture alone.
function(simwright_shared_headers)
endfunction()

# simwright_embed(TARGET NAMESPACE FILE...)
# Compiles data files into TARGET as `data::<file_name_with_underscores>()` in simwright::NAMESPACE,
# declared by the target's own header, so that an installed program needs no data folder.
function(simwright_embed target namespace)
  foreach(file ${ARGN})
    get_filename_component(name ${file} NAME)
    string(MAKE_C_IDENTIFIER ${name} identifier)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_${identifier}.cpp)
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -DINPUT=${CMAKE_CURRENT_SOURCE_DIR}/${file} -DOUTPUT=${output}
              -DNAMESPACE=${namespace} -DIDENTIFIER=${identifier}
              -P ${PROJECT_SOURCE_DIR}/cmake/embed_file.cmake
      DEPENDS ${file} ${PROJECT_SOURCE_DIR}/cmake/embed_file.cmake)
    target_sources(${target} PRIVATE ${output})
  endforeach()
endfunction()
