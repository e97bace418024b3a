static float float_of(uint32_t bits) {
    union { uint32_t bits; float value; } word = {bits};
    return word.value;
}

static uint32_t bits_of(float value) {
    union { float value; uint32_t bits; } word = {value};
    return word.bits;
}

static float magnitude_of(float x) { return float_of(bits_of(x) & 0x7FFFFFFFu); }

/* high in place of NaN and of what lies above */
static float at_most(float x, float high) { return x < high ? x : high; }

/* low in place of what lies below */
static float at_least(float x, float low) { return x > low ? x : low; }

/* x within the trained range; NaN stays NaN */
static float held(float x, float low, float high) {
    const float below = x > high ? high : x;
    return below < low ? low : below;
}

/* value within +-limit; zero for NaN */
static float limited(float value, float limit) {
    const float number = value != value ? 0.0f : value;
    const float below = number < limit ? number : limit;
    return below > -limit ? below : -limit;
}

/* the conversion that saturates and takes NaN to 0 */
static uint32_t saturated(float x) {
    return !(x > 0.0f) ? 0u : x >= 4294967296.0f ? 0xFFFFFFFFu : (uint32_t)x;
}

/* c0 + c1 t + c2 t^2 + c3 t^3 */
static float cubic(const float c[4], float t) { return ((c[3] * t + c[2]) * t + c[1]) * t + c[0]; }

/* the way through a cell, from 1 to 2 */
static float way(uint64_t product) { return float_of((uint32_t)product >> 9 | 0x3F800000u); }

/* exp(x) from -87 to 88.37 */
static float exp_of_held(float h) {
    const float rounded = h * 1.44269504088896340736f + 12582912.0f;
    const float n = rounded - 12582912.0f;
    float r = h - n * 0.6933594f;
    r = r - n * -2.1219444e-4f;
    float p = 1.9875691e-4f;
    p = p * r + 1.3982e-3f;
    p = p * r + 8.333452e-3f;
    p = p * r + 4.1665796e-2f;
    p = p * r + 0.16666666f;
    p = p * r + 0.5f;
    p = p * (r * r) + r + 1.0f;
    return p * float_of((bits_of(rounded) << 23) + 0x3F800000u);
}

/* exp(x), held at both ends */
static float f_exp(float x) { return exp_of_held(at_least(at_most(x, 88.37f), -87.0f)); }

/* exp(-|x|) */
static float f_decay(float x) { return exp_of_held(at_least(-magnitude_of(x), -87.0f)); }

/* 1 - exp(-ratio) of a lag */
static float lag_share(float ratio) {
    const float x = at_least(at_most(ratio, 1.0e6f), 0.0f);
    const float n = x * (1.0f + x * (0.5f + x * (1.0f / 6.0f + x * (1.0f / 24.0f))));
    return n / (1.0f + n);
}

/* ln |x| */
static float f_log(float x) {
    const float m = at_least(at_most(magnitude_of(x), 3.4028235e38f), 1.1754944e-38f);
    const uint32_t shifted = bits_of(m) + (0x3F800000u - 0x3F3504F3u);
    const float k = (float)((int32_t)(shifted >> 23) - 127);
    const float f = float_of((shifted & 0x007FFFFFu) + 0x3F3504F3u) - 1.0f;
    const float s = f / (2.0f + f);
    const float z = s * s;
    const float w = z * z;
    const float even = w * (0.40000972f + w * 0.24279079f);
    const float odd = z * (0.6666666f + w * 0.28498787f);
    const float half_square = 0.5f * f * f;
    return s * (half_square + (odd + even)) + k * 9.058001e-6f - half_square + f + k * 0.6931381f;
}

static float f_tanh(float x) {
    const float h = at_least(at_most(x, 7.905311f), -7.905311f);
    const float z = h * h;
    float p = -2.7607685e-16f;
    p = p * z + 2.000188e-13f;
    p = p * z + -8.604672e-11f;
    p = p * z + 5.122297e-8f;
    p = p * z + 1.4857224e-5f;
    p = p * z + 6.372619e-4f;
    p = p * z + 4.8935246e-3f;
    float q = 1.1982584e-6f;
    q = q * z + 1.1853471e-4f;
    q = q * z + 2.2684346e-3f;
    q = q * z + 4.893525e-3f;
    return (h * p) / q;
}

/* sin(r) within half a turn */
static float sin_half_turn(float r) {
    const float z = r * r;
    float p = -2.4080368e-8f;
    p = p * z + 2.7536475e-6f;
    p = p * z + -1.9841087e-4f;
    p = p * z + 8.333333e-3f;
    p = p * z + -0.16666667f;
    return p * z * r + r;
}

/* x - turns * pi */
static float less_half_turns(float x, float turns) {
    float r = x - turns * 3.140625f;
    r = r - turns * 9.6702576e-4f;
    return r - turns * 6.2783295e-7f;
}

static float f_sin(float x) {
    const float h = at_least(at_most(x, 32768.0f), -32768.0f);
    const float rounded = h * 0.318309886183790671538f + 12582912.0f;
    const float r = less_half_turns(h, rounded - 12582912.0f);
    return float_of(bits_of(sin_half_turn(r)) ^ (bits_of(rounded) << 31));
}

static float f_cos(float x) {
    const float h = at_most(magnitude_of(x), 32768.0f);
    const float rounded = h * 0.318309886183790671538f - 0.5f + 12582912.0f;
    const float r = less_half_turns(h, rounded - 12582912.0f + 0.5f);
    return float_of(bits_of(sin_half_turn(r)) ^ (~bits_of(rounded) << 31));
}

static float f_atan(float x) {
    const float h = at_most(x, 3.4028235e38f);
    const float m = magnitude_of(h);
    const int beyond = m > 1.0f;
    const float z = (beyond ? 1.0f : m) / (beyond ? m : 1.0f);
    const float s = z * z;
    float p = -2.5086075e-3f;
    p = p * s + 1.3996607e-2f;
    p = p * s + -3.6670484e-2f;
    p = p * s + 6.318236e-2f;
    p = p * s + -8.689052e-2f;
    p = p * s + 0.110420376f;
    p = p * s + -0.14279616f;
    p = p * s + 0.1999979f;
    p = p * s + -0.3333333f;
    const float near = p * s * z + z;
    const float angle = beyond ? 1.57079632679489661923f - near : near;
    return float_of(bits_of(angle) | (bits_of(h) & 0x80000000u));
}

/* |x|^p; 0 at 0 for p above 0 */
static float f_power(float x, float p) {
    const float result = f_exp(p * f_log(x));
    return x == 0.0f && p > 0.0f ? 0.0f : result;
}

/* sqrt |x|, correctly rounded, digit by digit; subnormal numbers count as zero */
static float f_square_root(float x) {
    const float m = at_most(magnitude_of(x), 3.4028235e38f);
    const uint32_t bits = bits_of(at_least(m, 1.1754944e-38f));
    const uint32_t exponent = (bits >> 23) + 127u;
    uint64_t rest = (uint64_t)((bits & 0x007FFFFFu) | 0x00800000u) << ((exponent & 1u) ? 26 : 25);
    uint64_t root = 0;
    for (uint64_t digit = (uint64_t)1 << 48; digit != 0; digit >>= 2) {
        const int taken = rest >= root + digit;
        rest -= taken ? root + digit : 0u;
        root = (root >> 1) + (taken ? digit : 0u);
    }
    const uint32_t rounded = (uint32_t)((root + 1u) >> 1);
    return m < 1.1754944e-38f ? 0.0f : float_of(((exponent >> 1) << 23) + rounded - 0x00800000u);
}

/* -1, 0 or 1; 0 for NaN */
static float f_sign(float x) { return x < 0.0f ? -1.0f : x > 0.0f ? 1.0f : 0.0f; }

static float least(float x, float y) { return x < y ? x : y; }

static float most(float x, float y) { return x > y ? x : y; }

static float squared(float x) { return x * x; }

static float divided(float x, float y) { return x / y; }

static int is_finite(float x) { return (bits_of(x) & 0x7FFFFFFFu) < 0x7F800000u; }

/* above 0 and at most 1 */
static int is_period(float dt) { return dt > 0.0f && dt <= 1.0f; }

/* a table whose cells grow with |x| + offset; a side has origin, last position, cells per 2^32 and the bits that turn the sign */
static float geometric(const float table[][4], float x, float offset, const uint32_t sides[2][4]) {
    const uint32_t *side = sides[bits_of(x) >> 31];
    const uint32_t distance = bits_of(magnitude_of(x) + offset) - side[0];
    const uint64_t product = (uint64_t)(distance < side[1] ? distance : side[1]) * side[2];
    return float_of(bits_of(cubic(table[product >> 32], way(product))) ^ side[3]);
}

/* a table of equal cells */
static float uniform(const float table[][4], float x, float low, float scale, const uint32_t place[2]) {
    const uint64_t product = (uint64_t)saturated((x - low) * scale) * place[1];
    return cubic(table[place[0] + (product >> 32)], way(product));
}

/* where a value lies among the rows of its edges, and the way through the row, 2^32 for the whole of it */
struct spot {
    uint32_t row, way;
};

static struct spot spot_of(uint32_t position, uint32_t rows) {
    const uint64_t product = (uint64_t)position * rows;
    const struct spot spot = {(uint32_t)(product >> 32), (uint32_t)product};
    return spot;
}

static struct spot spot_geometric(float x, float offset, const uint32_t sides[2][4]) {
    const uint32_t *side = sides[bits_of(x) >> 31];
    const uint32_t distance = bits_of(magnitude_of(x) + offset) - side[0];
    return spot_of(distance < side[1] ? distance : side[1], side[2]);
}

static struct spot spot_uniform(float x, float low, float scale, uint32_t rows) {
    return spot_of(saturated((x - low) * scale), rows);
}

/* the high word of a product */
static int32_t high(int32_t a, int32_t b) { return (int32_t)(((int64_t)a * b) >> 32); }

/* edges from a spot on, each a cubic of the way, onto the sums in which they end */
static void add_edges(uint32_t sums[], uint32_t targets, const int32_t edges[][4], struct spot spot) {
    const int32_t x = (int32_t)(spot.way >> 1);
    for (uint32_t target = 0; target < targets; target++) {
        const int32_t *a = edges[spot.row * targets + target];
        sums[target] += (uint32_t)a[0] + (uint32_t)high(a[1] + high(a[2] + high(a[3], x), x), x);
    }
}

/* a sample within the trained ranges; angle is the position as measured */
struct motion {
    float velocity, position, load, temperature, angle, law, dt, travel;
};

static float smooth_sign(const struct motion *m, float width) { return f_tanh(m->velocity / width); }

/* distance since the sample before; the memory is the position, and whether there was one */
static float travelled(float memory[4], float position) {
    const float distance = position - (memory[1] == 1.0f ? memory[0] : position);
    memory[0] = position;
    memory[1] = 1.0f;
    return distance;
}

/* lagged velocity (Hess & Soom 1990); the memory is it, and whether there was a sample before */
static float lagged(const struct motion *m, float memory[4], float time_constant) {
    const float before = memory[1] == 1.0f ? memory[0] : m->velocity;
    memory[0] = before + lag_share(m->dt / time_constant) * (m->velocity - before);
    memory[1] = 1.0f;
    return memory[0];
}

static float coulomb(const struct motion *m, float dry, float viscous, float width) {
    return dry * smooth_sign(m, width) + viscous * m->velocity;
}

static float stribeck(const struct motion *m, float amplitude, float velocity, float exponent, float width) {
    return amplitude * f_exp(-f_power(m->velocity / velocity, exponent)) * smooth_sign(m, width);
}

static float power_viscous(const struct motion *m, float coefficient, float exponent, float width) {
    return coefficient * f_power(m->velocity, exponent) * smooth_sign(m, width);
}

static float asymmetry(const struct motion *m, float dry, float viscous, float width) {
    return dry * magnitude_of(smooth_sign(m, width)) + viscous * magnitude_of(m->velocity);
}

static float temperature_friction(const struct motion *m, float reference, float dry, float viscous, float decay, float width) {
    const float warmth = m->temperature - reference;
    const float thinned = decay > 0.0f ? (1.0f - f_exp(-(decay * warmth))) / decay : warmth;
    return dry * smooth_sign(m, width) * warmth + viscous * m->velocity * thinned;
}

/* c is mean, difference and quadratic */
static float load_friction(const struct motion *m, const float c[3], float peak, float velocity, float width) {
    const float sign = smooth_sign(m, width);
    const float ratio = m->velocity / velocity;
    const float coefficient = c[0] + peak * f_exp(-(ratio * ratio));
    return coefficient * magnitude_of(m->load) * sign + c[1] * m->load * magnitude_of(sign) + c[2] * m->load * m->load * sign;
}

/* the memory is the filtered dissipated power, and what the last additions put in too much (Kahan 1965); c is time constant and limit */
static float warm_up(const struct motion *m, float memory[4], const float c[2], float dry, float viscous, float width) {
    const float power = least(magnitude_of(m->law * m->velocity), c[1]);
    const float increment = lag_share(m->dt / c[0]) * (power - memory[0]) - memory[1];
    const float sum = memory[0] + increment;
    memory[1] = (sum - memory[0]) - increment;
    memory[0] = least(most(sum, 0.0f), c[1]);
    return (dry * smooth_sign(m, width) + viscous * m->velocity) * memory[0];
}

/* z after a way that leaves a share of it */
static float turned_over(float z, float travel, float left) {
    const float rest = 1.0f - left;
    return z * left + float_of((bits_of(rest) & 0x7FFFFFFFu) | (bits_of(travel) & 0x80000000u));
}

/* Maxwell slip elements of torque and distance (Dahl 1968; Al-Bender, Lampaert & Swevers 2005); the memory is their shares */
static float presliding(const struct motion *m, float memory[4], const float elements[][2], int count, float width) {
    float torque = 0.0f, slipping = 0.0f;
    for (int i = 0; i < count; i++) {
        memory[i] = turned_over(memory[i], m->travel, f_decay(m->travel / elements[i][1]));
        torque = count == 1 ? elements[i][0] * memory[i] : torque + elements[i][0] * memory[i];
        slipping = count == 1 ? elements[i][0] : slipping + elements[i][0];
    }
    return torque - slipping * smooth_sign(m, width);
}

/* the memory is the time at rest, the way since, at most 20, and the latched torque; c is gain, time, distance, rest velocity, limit */
static float dwell_breakaway(const struct motion *m, float memory[4], const float c[5], float width) {
    const int resting = magnitude_of(m->velocity) < c[3];
    const float longer = least(memory[0] + m->dt, c[4]);
    const float farther = least(memory[1] + magnitude_of(m->travel) / c[2], 20.0f);
    memory[2] = resting ? c[0] * f_log(1.0f + longer / c[1]) : memory[2];
    memory[0] = resting ? longer : 0.0f;
    memory[1] = resting ? 0.0f : farther;
    return memory[2] * f_decay(memory[1]) * smooth_sign(m, width);
}

/* lines of order, cosine and sine */
static float ripple(const struct motion *m, const float lines[][3], int count) {
    float sum = 0.0f;
    for (int i = 0; i < count; i++) {
        const float angle = lines[i][0] * m->angle;
        sum = sum + (lines[i][1] * f_cos(angle) + lines[i][2] * f_sin(angle));
    }
    return sum;
}

/* how far the link is behind; the memory is the link's position, and whether there was a sample before */
static float play(const struct motion *m, float memory[4], float half_width) {
    const float low = m->position - half_width, high = m->position + half_width;
    const float before = memory[1] == 1.0f ? memory[0] : m->position;
    memory[0] = least(most(before, low), high);
    memory[1] = 1.0f;
    return m->position - memory[0];
}

/* the memory is how far it is wound */
static float windup(const struct motion *m, float memory[4], float torque, float distance) {
    memory[0] = turned_over(memory[0], m->travel, f_decay(m->travel / distance));
    return torque * memory[0];
}

static float spring(const struct motion *m, float stiffness, float rest) { return stiffness * (m->position - rest); }
