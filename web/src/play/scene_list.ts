/** A scene of the gallery, as the page lists it. */
export interface GalleryScene {
    title: string;
    note: string; // what to try, one sentence
    low: number[]; // the box that the picture takes in, m
    high: number[];
}

export const kGallery: Record<string, GalleryScene> = {
    octopus: {
        title: "Octopus",
        note: "Pull an arm, then pull it along w: it leaves the slice, and springs back.",
        low: [-1.4, -0.6, -1.4, -0.5],
        high: [1.4, 1.2, 1.4, 0.5],
    },
    jelly: {
        title: "Tesseract of jelly",
        note: "Let gravity point along w: it falls out of the slice, onto a wall.",
        low: [-0.8, 0, -0.8, -0.7],
        high: [0.8, 1.9, 0.8, 0.7],
    },
    heap: {
        title: "Heap of three",
        note: "They touch in four dimensions, also where the slice shows a gap between them.",
        low: [-1, 0, -1, -0.6],
        high: [1, 2.2, 1, 0.6],
    },
    bar: {
        title: "Twisted bar",
        note: "One end turns in the plane zw, to and fro; hold on to the middle.",
        low: [-1.5, -0.6, -0.6, -0.6],
        high: [1.5, 0.6, 0.6, 0.6],
    },
    worm: {
        title: "Worm with muscles",
        note: "Waves of activation travel through it, and friction takes it along. Hold it back.",
        low: [-1.8, 0, -0.6, -0.4],
        high: [1.8, 1, 0.6, 0.4],
    },
};
