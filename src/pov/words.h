/* words.h: POV-Ray's reserved words as numbers, and the words of a scene.
 *
 * The words are those of the reference of POV-Ray 3.7, "Identifiers and Keywords", as far as the
 * converter tells them apart. Others, and the scene's own names, get the numbers behind.
 */
#ifndef POV_WORDS_H
#define POV_WORDS_H

#include "writer/name_index.h"

#define POV_WORDS(X)                                                                               \
    /* directives */                                                                               \
    X(break) X(case) X(debug) X(declare) X(deprecated) X(default) X(else) X(elseif) X(end)         \
    X(error) X(fclose) X(fopen) X(for) X(if) X(ifdef) X(ifndef) X(include) X(local) X(macro)       \
    X(range) X(read) X(render) X(statistics) X(switch) X(undef) X(version) X(warning) X(while)     \
    X(write)                                                                                       \
    /* numbers */                                                                                  \
    X(abs) X(acos) X(acosh) X(asc) X(asin) X(asinh) X(atan) X(atan2) X(atanh) X(ceil) X(clock)     \
    X(clock_delta) X(clock_on) X(cos) X(cosh) X(defined) X(degrees) X(dimension_size)              \
    X(dimensions) X(div) X(exp) X(false) X(file_exists) X(final_clock) X(final_frame) X(floor)     \
    X(frame_number) X(image_height) X(image_width) X(initial_clock) X(initial_frame) X(inside)     \
    X(int) X(ln) X(log) X(max) X(max_extent) X(min) X(min_extent) X(mod) X(no) X(now) X(off)       \
    X(on) X(pi) X(pow) X(radians) X(rand) X(seed) X(select) X(sin) X(sinh) X(sqrt) X(strcmp)       \
    X(strlen) X(t) X(tan) X(tanh) X(tau) X(trace) X(true) X(u) X(v) X(val) X(vaxis_rotate)         \
    X(vcross) X(vdot) X(vlength) X(vnormalize) X(vrotate) X(vturbulence) X(x) X(y) X(yes) X(z)     \
    /* strings, arrays, functions */                                                               \
    X(array) X(chr) X(concat) X(datetime) X(function) X(internal) X(spline) X(str) X(strlwr)       \
    X(strupr) X(substr) X(vstr)                                                                    \
    /* colours */                                                                                  \
    X(alpha) X(blue) X(color) X(colour) X(filter) X(gray) X(green) X(red) X(rgb) X(rgbf) X(rgbft)  \
    X(rgbt) X(srgb) X(srgbf) X(srgbft) X(srgbt) X(transmit)                                        \
    /* transforms */                                                                               \
    X(inverse) X(matrix) X(rotate) X(scale) X(transform) X(translate)                              \
    /* textures */                                                                                 \
    X(accuracy) X(agate) X(agate_turb) X(control0) X(control1) X(form) X(metric)                   \
    X(noise_generator) X(offset) X(solid) X(albedo) X(all) X(altitude) X(ambient)                  \
    X(ambient_light) X(assumed_gamma) X(average) X(black_hole) X(boxed) X(bozo) X(brick)           \
    X(brick_size) X(brilliance) X(bump_map) X(bump_size) X(bumps) X(cells) X(checker)              \
    X(color_map) X(colour_map) X(conserve_energy) X(crackle) X(crand) X(cubic) X(cylindrical)      \
    X(density_file) X(dents) X(diffuse) X(emission) X(exponent) X(exterior) X(facets)              \
    X(fade_color) X(fade_colour) X(fade_distance) X(fade_power) X(falloff) X(finish) X(frequency)  \
    X(fresnel) X(gamma) X(gradient) X(granite) X(hexagon) X(image_map) X(image_pattern)            \
    X(interior) X(interior_texture) X(interpolate) X(ior) X(irid) X(julia) X(lambda) X(leopard)    \
    X(magnet) X(mandel) X(map_type) X(marble) X(material) X(material_map) X(metallic) X(mortar)    \
    X(normal) X(normal_map) X(octaves) X(omega) X(once) X(onion) X(pavement) X(phase) X(phong)     \
    X(phong_size) X(pigment) X(pigment_map) X(pigment_pattern) X(planar) X(quick_color)            \
    X(quick_colour) X(tiles) X(tile2) X(poly_wave) X(quilted) X(radial) X(ramp_wave)               \
    X(reflection) X(reflection_exponent) X(repeat) X(ripples) X(roughness) X(scallop_wave)         \
    X(sine_wave) X(slope) X(specular) X(spherical) X(spiral1) X(spiral2) X(spotted) X(square)      \
    X(subsurface) X(texture) X(texture_map) X(thickness) X(tiling) X(triangular) X(triangle_wave)  \
    X(turbulence) X(uv_mapping) X(warp) X(waves) X(wood) X(wrinkles)                               \
    /* pictures */                                                                                 \
    X(bmp) X(exr) X(gif) X(hdr) X(iff) X(jpeg) X(pgm) X(png) X(pot) X(ppm) X(sys) X(tga) X(tiff)   \
    X(smooth) X(water_level) X(hierarchy) X(premultiplied)                                         \
    /* objects */                                                                                  \
    X(b_spline) X(bezier_spline) X(bicubic_patch) X(blob) X(bounded_by) X(box) X(clipped_by)       \
    X(conic_sweep) X(cone) X(cubic_spline) X(cylinder) X(difference) X(disc) X(double_illuminate)  \
    X(face_indices) X(flatness) X(height_field) X(hollow) X(inside_vector) X(intersection)         \
    X(isosurface) X(julia_fractal) X(lathe) X(light_group) X(light_source) X(linear_spline)        \
    X(linear_sweep) X(merge) X(mesh) X(mesh2) X(no_image) X(no_reflection) X(no_shadow)            \
    X(normal_indices) X(normal_vectors) X(object) X(open) X(ovus) X(parametric) X(photons)         \
    X(plane) X(poly) X(polygon) X(polynomial) X(prism) X(quadratic_spline) X(quadric) X(quartic)   \
    X(smooth_triangle) X(sor) X(sphere) X(sphere_sweep) X(split_union) X(sturm) X(superellipsoid)  \
    X(text) X(texture_list) X(torus) X(triangle) X(type) X(u_steps) X(union) X(uv_indices)         \
    X(uv_vectors) X(v_steps) X(vertex_vectors)                                                     \
    /* lights, camera, surroundings */                                                             \
    X(adaptive) X(angle) X(aperture) X(area_illumination) X(area_light) X(background)              \
    X(blur_samples) X(camera) X(circular) X(confidence) X(direction) X(fisheye) X(focal_point)     \
    X(fog) X(global_lights) X(global_settings) X(jitter) X(location) X(look_at) X(looks_like)      \
    X(max_trace_level) X(media) X(media_attenuation) X(media_interaction) X(omnimax) X(orient)     \
    X(orthographic) X(panoramic) X(parallel) X(perspective) X(point_at) X(projected_through)       \
    X(radiosity) X(radius) X(rainbow) X(right) X(shadowless) X(sky) X(sky_sphere) X(spotlight)     \
    X(tightness) X(ultra_wide_angle) X(up) X(variance) X(mesh_camera) X(density) X(hf_gray_16)     \
    X(absorption) X(scattering) X(samples) X(intervals) X(dispersion) X(dispersion_samples)        \
    X(caustics)

enum pov_word {
#define POV_WORD_NUMBER(name) POV_##name,
    POV_WORDS(POV_WORD_NUMBER)
#undef POV_WORD_NUMBER
        POV_WORD_COUNT
};

/* Zeroed: empty. */
struct pov_words {
    const char **texts; /* by number */
    size_t count, capacity;
    struct name_index index;
};

struct arena;

/* Enters the reserved words. False: out of memory. */
bool pov_words_start(struct pov_words *words);
void pov_words_release(struct pov_words *words);

/* The number of a word, which is copied to the arena where it is new. False: out of memory. */
bool pov_words_number(struct pov_words *words, struct arena *arena, const char *text, size_t length,
                      uint32_t *number);

#endif
