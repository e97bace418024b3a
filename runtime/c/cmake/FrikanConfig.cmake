# find_package(Frikan CONFIG): the target Frikan::frikan, the static library of this checkout, which cargo builds for the processor of the firmware.
# CMAKE_PREFIX_PATH or Frikan_DIR names this folder. To be set before:
#
#   FRIKAN_TARGET    Rust's name of the processor, such as thumbv7em-none-eabihf (`rustup target add` installs it)
#   FRIKAN_FEATURES  features in place of the default ones, such as "supervised,slots,expression"; empty for the default ones
#   FRIKAN_CELLS     room for so many cells, where a feature decodes models
#
# The firmware links with --gc-sections: what it never calls is left out.
if(NOT FRIKAN_TARGET)
    set(Frikan_FOUND FALSE)
    set(Frikan_NOT_FOUND_MESSAGE "FRIKAN_TARGET does not name the processor, such as thumbv7em-none-eabihf")
    return()
endif()
find_program(FRIKAN_CARGO cargo HINTS ENV CARGO_HOME PATH_SUFFIXES bin)
if(NOT FRIKAN_CARGO)
    set(Frikan_FOUND FALSE)
    set(Frikan_NOT_FOUND_MESSAGE "cargo is not installed")
    return()
endif()

if(NOT TARGET Frikan::frikan)
    get_filename_component(_frikan_c "${CMAKE_CURRENT_LIST_DIR}/.." REALPATH)
    set(_frikan_folder "${CMAKE_BINARY_DIR}/frikan")
    set(_frikan_library "${_frikan_folder}/${FRIKAN_TARGET}/drive/libfrikan.a")
    set(_frikan_features)
    if(FRIKAN_FEATURES)
        set(_frikan_features --no-default-features --features ${FRIKAN_FEATURES})
    endif()
    set(_frikan_environment)
    if(FRIKAN_CELLS)
        set(_frikan_environment ${CMAKE_COMMAND} -E env FRIKAN_CELLS=${FRIKAN_CELLS})
    endif()
    # cargo knows what is up to date.
    add_custom_target(frikan_cargo
        COMMAND ${_frikan_environment} ${FRIKAN_CARGO} rustc --quiet --manifest-path ${_frikan_c}/Cargo.toml --package frikan-c
                --profile drive --crate-type staticlib --target ${FRIKAN_TARGET} --target-dir ${_frikan_folder} ${_frikan_features}
        BYPRODUCTS ${_frikan_library}
        VERBATIM)
    file(MAKE_DIRECTORY "${_frikan_folder}")
    add_library(Frikan::frikan STATIC IMPORTED GLOBAL)
    set_target_properties(Frikan::frikan PROPERTIES
        IMPORTED_LOCATION "${_frikan_library}"
        INTERFACE_INCLUDE_DIRECTORIES "${_frikan_c}/include")
    # The header has to know what the library was built with.
    if(FRIKAN_FEATURES MATCHES "expression|network|effects|models")
        set_property(TARGET Frikan::frikan APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS FRIKAN_MODELS)
        if(FRIKAN_CELLS)
            set_property(TARGET Frikan::frikan APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS FRIKAN_CELLS=${FRIKAN_CELLS})
        endif()
    endif()
    add_dependencies(Frikan::frikan frikan_cargo)
endif()
set(Frikan_FOUND TRUE)
