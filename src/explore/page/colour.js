// colour.js: from samples of layers to bytes of a canvas.
//
// Radiance is linear Rec.709; the page multiplies it by 2^exposure and encodes it as sRGB (IEC 61966-2-1). Layers that
// hold no light have pictures of their own: normals as (n + 1) / 2, positions and distances over their range. All are
// dithered to bytes, as PNG files are (tonemap.h): noiseless walls would show the steps as bands.

const table_size = 8192;

// sRGB by a table over the square root of what is encoded: it is nearly even in what the eye sees.
const srgb_table = Float32Array.from({length: table_size + 1}, (_, i) => {
    const linear = (i / table_size) ** 2;
    return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
});

// And back, over what is encoded, 0..1.
const linear_table = Float32Array.from({length: table_size + 1}, (_, i) => {
    const encoded = i / table_size;
    return encoded <= 0.04045 ? encoded / 12.92 : ((encoded + 0.055) / 1.055) ** 2.4;
});

// Nine colours of "magma" (N. Smith, S. van der Walt, for matplotlib, 2015), evenly spaced, as in `psplat compare`.
const magma = [[0, 0, 4], [28, 16, 68], [79, 18, 123], [129, 37, 129], [181, 54, 122], [229, 80, 100],
    [251, 135, 97], [254, 194, 135], [252, 253, 191]];
// From what is darker over black to what is brighter.
const difference_colours = [[150, 220, 255], [50, 130, 230], [10, 50, 110], [0, 0, 0], [110, 40, 0], [230, 110, 20],
    [255, 220, 140]];

function ramp(colours, position) {
    const scaled = Math.min(Math.max(position, 0), 1) * (colours.length - 1);
    const step = Math.min(Math.floor(scaled), colours.length - 2);
    return colours[step].map((low, c) => low + (scaled - step) * (colours[step + 1][c] - low));
}

function ramp_table(colours) {
    const bytes = new Uint8ClampedArray(3 * 256);
    for (let i = 0; i < 256; i++)
        bytes.set(ramp(colours, i / 255), 3 * i);
    return bytes;
}

export const magma_table = ramp_table(magma);
export const difference_table = ramp_table(difference_colours);

const not_a_number = [255, 0, 255]; // magenta: nothing that is rendered has it

// What a layer shows: "light" is linear, "shown" is encoded already (an exposure decodes it and encodes it anew),
// "direction" is -1..1, and "range" is spread from its least to its largest value.
export function kindOfLayer(name) {
    if (name === "display")
        return "shown";
    if (name === "N")
        return "direction";
    return ["P", "Z", "weight", "error"].includes(name) ? "range" : "light";
}

export function takesExposure(name) {
    return ["shown", "light"].includes(kindOfLayer(name));
}

function rangeOf(samples, channels, channel) {
    let least = Infinity, largest = -Infinity;
    for (let i = channel; i < samples.length; i += channels) {
        const value = samples[i];
        if (Number.isFinite(value)) {
            least = Math.min(least, value);
            largest = Math.max(largest, value);
        }
    }
    return largest > least ? [least, largest] : [0, largest > 0 ? largest : 1];
}

// Samples as values of a display, 0..255. Loops of their own, as a function for each sample takes several times as long.

function encodeLight(samples, values, exposure) {
    const factor = 2 ** exposure;
    for (let i = 0; i < samples.length; i++) {
        const linear = factor * samples[i];
        values[i] = linear >= 1 ? 255 : linear > 0 ? srgb_table[(Math.sqrt(linear) * table_size + 0.5) | 0] : 0;
    }
}

function encodeLinearly(samples, values, channels, channel, [low, high]) {
    const factor = 255 / (high - low);
    for (let i = channel; i < samples.length; i += channels)
        values[i] = factor * (samples[i] - low);
}

function decode(samples) {
    return samples.map((encoded) => linear_table[(Math.min(Math.max(encoded, 0), 1) * table_size + 0.5) | 0]);
}

function encode(layer, {samples, channels}, exposure) {
    const kind = kindOfLayer(layer), values = new Float32Array(samples.length);
    if (kind === "shown" && exposure !== 0) {
        encodeLight(decode(samples), values, exposure);
        return values;
    }
    if (kind === "light") {
        encodeLight(samples, values, exposure);
        return values;
    }
    for (let c = 0; c < channels; c++) {
        const range = kind === "shown" ? [0, 1] : kind === "direction" ? [-1, 1] : rangeOf(samples, channels, c);
        encodeLinearly(samples, values, channels, c, range);
    }
    return values;
}

// Interleaved gradient noise (Jimenez 2014), -0.49..0.49.
function ditherAt(x, y) {
    const inner = 0.06711056 * x + 0.00583715 * y, outer = 52.9829189 * (inner - Math.floor(inner));
    return 0.49 * (2 * (outer - Math.floor(outer)) - 1);
}

// A layer as ImageData, which rounds.
export function paintLayer(picture, layer, exposure) {
    const {width, height, channels, samples} = picture;
    const image = new ImageData(width, height), data = image.data;
    const values = encode(layer, picture, exposure);
    const green = channels === 3 ? 1 : 0, blue = 2 * green;
    for (let y = 0, i = 0, o = 0; y < height; y++) {
        for (let x = 0; x < width; x++, i += channels, o += 4) {
            const dither = ditherAt(x, y);
            data[o] = values[i] + dither;
            data[o + 1] = values[i + green] + dither;
            data[o + 2] = values[i + blue] + dither;
            data[o + 3] = 255;
            if (Number.isNaN(samples[i] + samples[i + green] + samples[i + blue]))
                data.set(not_a_number, o);
        }
    }
    return image;
}

// position(i): 0..1 for pixel i, coloured by a table of 256 colours.
function paintPositions(width, height, table, position) {
    const image = new ImageData(width, height), data = image.data;
    for (let i = 0, o = 0; o < data.length; i++, o += 4) {
        const step = 3 * Math.round(255 * Math.min(Math.max(position(i), 0), 1));
        data[o] = table[step];
        data[o + 1] = table[step + 1];
        data[o + 2] = table[step + 2];
        data[o + 3] = 255;
        if (Number.isNaN(step))
            data.set(not_a_number, o);
    }
    return image;
}

// A map of errors, 0..1, in one channel.
export function paintMap(map) {
    return paintPositions(map.width, map.height, magma_table, (i) => map.samples[i]);
}

function luminance(picture, i) {
    if (picture.channels === 1)
        return picture.samples[i];
    const s = picture.samples;
    return 0.2126 * s[3 * i] + 0.7152 * s[3 * i + 1] + 0.0722 * s[3 * i + 2];
}

// b - a in luminance; the ends of the ramp are -largest and +largest. null for pictures of different sizes.
export function paintDifference(a, b, largest) {
    if (a.width !== b.width || a.height !== b.height || a.channels !== b.channels)
        return null;
    return paintPositions(a.width, a.height, difference_table,
        (i) => 0.5 + 0.5 * (luminance(b, i) - luminance(a, i)) / largest);
}
