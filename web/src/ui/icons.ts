/** Paths of icons, 24 x 24, drawn as lines. */
export const kIcons = {
    open: "M3 7a2 2 0 0 1 2-2h4l2 2.5h8a2 2 0 0 1 2 2V17a2 2 0 0 1-2 2H5a2 2 0 0 1-2-2z",
    save: "M12 4v11m0 0l-4.5-4.5M12 15l4.5-4.5M4.5 19.5h15",
    help: "M9.2 9.2a2.9 2.9 0 1 1 4.3 2.5c-1 .6-1.5 1.2-1.5 2.3M12 17.6v.1M21 12a9 9 0 1 1-18 0 9 9 0 0 1 18 0z",
    theme: "M12 3a9 9 0 1 0 0 18zM12 3a9 9 0 0 1 0 18",
    panel: "M4 7h9m5 0h2M4 17h2m5 0h9M15.5 4.8v4.4M8.5 14.8v4.4",
    play: "M7 4.5v15l12-7.5z",
    pause: "M8 5v14M16 5v14",
    previous: "M15 5l-7 7 7 7",
    next: "M9 5l7 7-7 7",
    loop: "M4 12a6.5 6.5 0 0 1 6.5-6.5H18m0 0L15 2.6M18 5.5l-3 2.9M20 12a6.5 6.5 0 0 1-6.5 6.5H6m0 0l3 2.9m-3-2.9l3-2.9",
    reset: "M4.5 12a7.5 7.5 0 1 0 2.4-5.5M4.5 4v4.5H9",
    step: "M6 5v14l9-7zM18.5 5v14",
    begin: "M6 5v14M19 5v14l-10-7z",
    record: "M12 6.5a5.5 5.5 0 1 0 0 11a5.5 5.5 0 1 0 0-11z",
    stop: "M7 7h10v10H7z",
    close: "M6 6l12 12M18 6L6 18",
} as const;
