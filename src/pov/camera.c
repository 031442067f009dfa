/* camera.c: reads the camera; see object.h and the reference of POV-Ray 3.7, "Camera". */
#include "pov/expression.h"
#include "pov/object.h"

static const struct pov_camera usual = {.direction = {0, 0, 1},
                                        .right = {4.0 / 3.0, 0, 0},
                                        .up = {0, 1, 0},
                                        .sky = {0, 1, 0},
                                        .place = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};

static struct vector *vector_of_word(struct pov_camera *camera, uint32_t word)
{
    switch (word) {
    case POV_location:
        return &camera->location;
    case POV_direction:
        return &camera->direction;
    case POV_right:
        return &camera->right;
    case POV_up:
        return &camera->up;
    case POV_sky:
        return &camera->sky;
    case POV_look_at:
        return &camera->look_at;
    case POV_focal_point:
        return &camera->focal_point;
    default:
        return NULL;
    }
}

static void read_word(struct pov_reader *reader, const struct pov_token *token,
                      struct pov_camera *camera)
{
    struct vector *vector = vector_of_word(camera, token->word);
    if (vector) {
        *vector = pov_read_vector(reader);
        camera->has_look_at = camera->has_look_at || token->word == POV_look_at;
        camera->has_focal_point = camera->has_focal_point || token->word == POV_focal_point;
        return;
    }
    switch (token->word) {
    case POV_perspective:
        break;
    case POV_orthographic:
        camera->orthographic = true;
        break;
    case POV_angle:
        camera->angle = pov_read_float(reader);
        pov_skip_comma(reader);
        pov_read_optional(reader, 0.0);
        break;
    case POV_aperture:
        camera->aperture = pov_read_float(reader);
        break;
    case POV_blur_samples:
    case POV_variance:
    case POV_confidence:
        pov_read_float(reader);
        pov_skip_comma(reader);
        pov_read_optional(reader, 0.0);
        break;
    case POV_normal:
        pov_warn(reader, token, "normal of the camera is left out");
        pov_skip_braces(reader);
        break;
    case POV_fisheye:
    case POV_ultra_wide_angle:
    case POV_omnimax:
    case POV_panoramic:
    case POV_cylinder:
    case POV_spherical:
    case POV_mesh_camera:
        pov_warn(reader, token, "camera: %s becomes perspective", pov_text(reader, token->word));
        pov_read_optional(reader, 0.0);
        pov_skip_braces(reader);
        break;
    default:
        pov_unexpected(reader, token, "a part of a camera, or '}'");
    }
}

struct pov_camera pov_read_camera(struct pov_reader *reader)
{
    struct pov_camera camera = usual;
    struct pov_token token;
    pov_expect(reader, '{');
    while (token = pov_next(reader), !pov_is(&token, '}') && token.kind != POV_END) {
        const struct pov_value *value = pov_named(reader, &token);
        if (value && value->kind == POV_VALUE_CAMERA)
            camera = *value->camera;
        else if (pov_is(&token, ',') || pov_read_transform(reader, &token, &camera.place))
            continue;
        else if (token.kind == POV_WORD)
            read_word(reader, &token, &camera);
        else
            pov_unexpected(reader, &token, "a part of a camera, or '}'");
    }
    return camera;
}
