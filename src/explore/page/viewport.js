// viewport.js: pictures in a canvas, with pan and zoom.
//
// A place is what is seen: several viewports share one, so that they show the same part. It is told in pictures' widths
// and heights, so that pictures of other sizes (previews) lie over each other: the centre by (u, v) in 0..1, and the
// scale by the CSS pixels that the whole width takes. Zoom is in CSS pixels for a pixel of the picture. Above 1, pixels
// are squares, as they are what one looks for.

const least_zoom = 1 / 64, largest_zoom = 64;

export class Place extends EventTarget {
    constructor() {
        super();
        this.fitted = true;
        this.scale = 1;
        this.u = this.v = 0.5;
    }

    fit() {
        this.fitted = true;
        this.u = this.v = 0.5;
        this.changed();
    }

    // The zoom of a picture of that frame, {width, height}, with its point (u, v) held at `dx`, `dy` CSS pixels from the
    // viewport's centre.
    zoomTo(zoom, frame, u = this.u, v = this.v, dx = 0, dy = 0) {
        this.fitted = false;
        const taken = Math.min(Math.max(zoom, least_zoom), largest_zoom);
        this.scale = taken * frame.width;
        this.moveTo(u - dx / (taken * frame.width), v - dy / (taken * frame.height));
    }

    moveTo(u, v) {
        this.u = Math.min(Math.max(u, 0), 1);
        this.v = Math.min(Math.max(v, 0), 1);
        this.changed();
    }

    changed() {
        this.dispatchEvent(new Event("change"));
    }
}

export class Viewport extends EventTarget {
    // Events: "point" when the pointer moves, with detail {u, v} or null outside of the picture; "pick" when it is
    // clicked, likewise; "split" when the divider is dragged, with detail 0..1.
    constructor(canvas, place) {
        super();
        this.canvas = canvas;
        this.place = place;
        this.images = []; // one, or two under a slider; null where there is none
        this.split = 0.5;
        this.overlay = null; // draws over the picture: (context, at), where at([x, y]) is where a pixel lies in the canvas
        this.frame = {width: 1, height: 1};
        this.due = false;
        place.addEventListener("change", () => this.draw());
        new ResizeObserver(() => this.draw()).observe(canvas);
        this.listen();
    }

    // Images are canvases, drawn as large as `frame`, the size of the whole picture.
    show(images, frame, split) {
        this.images = images;
        this.frame = frame;
        this.split = split;
        this.draw();
    }

    zoom() {
        if (!this.place.fitted)
            return this.place.scale / this.frame.width;
        const {clientWidth, clientHeight} = this.canvas;
        return Math.min(clientWidth / this.frame.width, clientHeight / this.frame.height, largest_zoom);
    }

    // Once a frame of the display at the most.
    draw() {
        if (this.due)
            return;
        this.due = true;
        requestAnimationFrame(() => {
            this.due = false;
            this.drawNow();
        });
    }

    drawNow() {
        const canvas = this.canvas, ratio = window.devicePixelRatio || 1;
        const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
        if (canvas.width !== width || canvas.height !== height)
            [canvas.width, canvas.height] = [width, height];
        const context = canvas.getContext("2d");
        context.clearRect(0, 0, width, height);
        const scale = this.zoom() * ratio;
        const w = scale * this.frame.width, h = scale * this.frame.height;
        const left = Math.round(width / 2 - this.place.u * w), top = Math.round(height / 2 - this.place.v * h);
        const divider = Math.round(this.split * width);
        this.images.forEach((image, i) => {
            if (!image)
                return;
            context.save();
            if (this.images.length > 1) {
                context.beginPath();
                context.rect(i ? divider : 0, 0, i ? width - divider : divider, height);
                context.clip();
            }
            // Pixels are seen as they are, but those of a preview, which stand for many.
            context.imageSmoothingEnabled = w < image.width || image.width < this.frame.width;
            context.imageSmoothingQuality = "high";
            context.drawImage(image, left, top, Math.round(w), Math.round(h));
            context.restore();
        });
        this.overlay?.(context, ([x, y]) => [left + x * scale, top + y * scale]);
        if (this.images.length > 1) {
            context.fillStyle = "#000";
            context.fillRect(divider - 2 * ratio, 0, 4 * ratio, height);
            context.fillStyle = "#fff";
            context.fillRect(divider - ratio, 0, 2 * ratio, height);
        }
    }

    // Where an event is: CSS pixels from the centre, and in the picture.
    locate(event) {
        const box = this.canvas.getBoundingClientRect(), zoom = this.zoom();
        const dx = event.clientX - box.left - box.width / 2, dy = event.clientY - box.top - box.height / 2;
        return {
            dx, dy, x: (event.clientX - box.left) / box.width,
            u: this.place.u + dx / (zoom * this.frame.width), v: this.place.v + dy / (zoom * this.frame.height),
        };
    }

    tell(name, at) {
        const inside = at && at.u >= 0 && at.u < 1 && at.v >= 0 && at.v < 1;
        this.dispatchEvent(new CustomEvent(name, {detail: inside ? {u: at.u, v: at.v} : null}));
    }

    isOnDivider(at) {
        return this.images.length > 1 && Math.abs(at.x - this.split) * this.canvas.clientWidth < 8;
    }

    listen() {
        const canvas = this.canvas;
        let drag = null;
        canvas.addEventListener("pointerdown", (event) => {
            if (event.button !== 0)
                return;
            const at = this.locate(event);
            drag = {at, u: this.place.u, v: this.place.v, divides: this.isOnDivider(at), moved: false};
            canvas.setPointerCapture(event.pointerId);
        });
        canvas.addEventListener("pointermove", (event) => {
            const at = this.locate(event);
            canvas.classList.toggle("divides", this.isOnDivider(at) || Boolean(drag?.divides));
            if (drag)
                this.drag(drag, at);
            this.tell("point", at);
        });
        const end = (event) => {
            if (drag && !drag.moved && event.type === "pointerup")
                this.tell("pick", drag.at);
            drag = null;
        };
        canvas.addEventListener("pointerup", end);
        canvas.addEventListener("pointercancel", end);
        canvas.addEventListener("pointerleave", () => this.tell("point", null));
        canvas.addEventListener("wheel", (event) => {
            event.preventDefault();
            const at = this.locate(event), lines = event.deltaMode === 1 ? 16 : 1;
            this.place.zoomTo(this.zoom() * 2 ** (-event.deltaY * lines / 240), this.frame, at.u, at.v, at.dx, at.dy);
        }, {passive: false});
        canvas.addEventListener("dblclick", () => this.place.fit());
    }

    drag(drag, at) {
        if (Math.hypot(at.dx - drag.at.dx, at.dy - drag.at.dy) > 3)
            drag.moved = true;
        if (!drag.moved)
            return;
        if (drag.divides) {
            this.dispatchEvent(new CustomEvent("split", {detail: Math.min(Math.max(at.x, 0), 1)}));
            return;
        }
        this.place.zoomTo(this.zoom(), this.frame, drag.u, drag.v, at.dx - drag.at.dx, at.dy - drag.at.dy);
    }
}

// A canvas that holds an ImageData, to draw from: `reused` where it suits.
export function canvasOf(image, reused) {
    const canvas = reused || document.createElement("canvas");
    if (canvas.width !== image.width || canvas.height !== image.height)
        [canvas.width, canvas.height] = [image.width, image.height];
    canvas.getContext("2d").putImageData(image, 0, 0);
    return canvas;
}
