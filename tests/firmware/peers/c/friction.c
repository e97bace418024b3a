/* Stribeck friction, N m at rad/s, as it is written in C for a drive. */
#include <math.h>

float friction_newlib_float(float velocity) {
    return (22.0f + 8.0f * expf(-fabsf(velocity / 0.1f))) * tanhf(50.0f * velocity) + 0.03f * velocity;
}

/* The same with the double-precision functions: a common slip, since `exp` compiles as well as `expf`. */
float friction_newlib_double(float velocity) {
    return (22.0 + 8.0 * exp(-fabs(velocity / 0.1))) * tanh(50.0 * velocity) + 0.03 * velocity;
}

#define ENTRIES 256
static const float low = -2.0f, high = 2.0f;

/* Linear interpolation in a table that start-up filled, ends held. */
float friction_linear_table(const float *table, float velocity) {
    float position = (velocity - low) * ((ENTRIES - 1) / (high - low));
    position = position > 0.0f ? position : 0.0f;
    position = position < ENTRIES - 1 ? position : ENTRIES - 1;
    unsigned index = (unsigned)position;
    index = index < ENTRIES - 2 ? index : ENTRIES - 2;
    float fraction = position - (float)index;
    return table[index] + fraction * (table[index + 1] - table[index]);
}
