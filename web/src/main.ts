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
    byId("stage").append(
        element(
            "div",
            { class: "failure", role: "alert" },
            element("h2", {}, "This cannot be shown here"),
            element("p", {}, error.message),
        ),
    );
}

try {
    const app = new App();
    window.pentimento = app;
    app.start().catch(showFailure);
} catch (error) {
    showFailure(error as Error);
}
