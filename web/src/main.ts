import "./ui/style.css";
import { App } from "./ui/app.ts";
import { byId, element } from "./ui/dom.ts";

declare global {
    interface Window {
        pentimento?: App; // for tests, and for the curious
    }
}

// Whatever goes wrong, there are words on the page.
function showFailure(error: Error): void {
    document.body.append(
        element(
            "main",
            { class: "failure", role: "alert" },
            element("h1", {}, "This cannot be shown here"),
            element("p", {}, error.message),
            element(
                "p",
                {},
                "Pictures, movies and slices of the same bodies need no graphics card: " +
                    "pent-render RUN/ -o movie.mp4, pent-slice RUN/ -o slices/",
            ),
        ),
    );
    byId("app").remove();
}

try {
    const app = new App();
    window.pentimento = app;
    app.start().catch(showFailure);
} catch (error) {
    showFailure(error as Error);
}
