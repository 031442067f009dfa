// numbers.js: numbers as people read them, and sliders over ranges of many powers of ten.

// Three digits, or `digits`, without an exponent where there is no need of one.
export function short(value, digits = 3) {
    if (!Number.isFinite(value))
        return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
    const size = Math.abs(value);
    if (size !== 0 && (size < 1e-4 || size >= 1e7))
        return value.toExponential(digits - 1);
    return String(size >= 10 ** digits ? Math.round(value) : Number(value.toPrecision(digits)));
}

export function seconds(value) {
    if (value < 60)
        return `${value.toFixed(1)} s`;
    const minutes = Math.floor(value / 60);
    return `${minutes} min ${Math.floor(value - 60 * minutes)} s`;
}

// A slider's positions, 0..1, for values of a row {type, minimum, maximum, default}. In a range that is wide beside the
// default, steps grow with the distance from the minimum: value = minimum + unit (growth^(3 position) - 1), where unit
// and growth are such that the default lies at a third. null for a row without an end, or as good as none.
export function sliderOf(row) {
    const {minimum, maximum} = row;
    if (!Number.isFinite(minimum) || !Number.isFinite(maximum) || maximum <= minimum || maximum - minimum > 1e9)
        return null;
    const range = maximum - minimum, usual = Number(row.default) - minimum; // NaN where the default is a word
    const least = row.minimum_excluded ? minimum + range * 1e-6 : minimum;
    const tidy = (value) => {
        const rounded = row.type === "integer" ? Math.round(value) : Number(value.toPrecision(3));
        return Math.min(Math.max(rounded, least), maximum);
    };
    const ratio = range / (usual > 0 ? usual : range / 1000);
    if (ratio < 8 || (!(usual > 0) && range < 100)) {
        return {
            position: (value) => (value - minimum) / range,
            value: (position) => tidy(minimum + position * range),
        };
    }
    const growth = (Math.sqrt(4 * ratio - 3) - 1) / 2; // growth^2 + growth + 1 = ratio
    const unit = range / (growth ** 3 - 1);
    return {
        position: (value) => Math.log(1 + Math.max(value - minimum, 0) / unit) / (3 * Math.log(growth)),
        value: (position) => tidy(minimum + unit * (growth ** (3 * position) - 1)),
    };
}

// Two ticks at the least, a whole number of equal steps from 0.
function evenTicks(low, high) {
    const step = 10 ** Math.floor(Math.log10((high - low) / 2)), ticks = [];
    for (let i = Math.ceil(low / step); i * step <= high; i++)
        ticks.push(Number((i * step).toPrecision(12)));
    return ticks;
}

// Ticks of a logarithmic axis from `low` to `high`, both above 0: powers of ten, with 2 and 5 between where these are
// few; even ones in a range that is so short that it has none or one of them.
export function logTicks(low, high) {
    const ticks = [], decades = Math.log10(high / low);
    const steps = decades > 3 ? [1] : decades > 1 ? [1, 2, 5] : [1, 1.5, 2, 3, 5, 7];
    for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; power++) {
        for (const step of steps) {
            const tick = step * 10 ** power;
            if (tick >= low * 0.999 && tick <= high * 1.001)
                ticks.push(tick);
        }
    }
    return ticks.length < 2 ? evenTicks(low, high) : ticks;
}
